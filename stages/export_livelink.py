"""Write a take's weights as Live Link Face writes them, the shortest way into Unreal.

The rig's shapes are found by the table of names, in any spelling that it knows. A shape that the
rig splits, or has under several masks, is the mean of its parts; shapes that the rig lacks are 0
and named in the log, as are shapes that have no place in the format. The timecode of a frame is its
time from the film's first picture. The format has no place for the head's position.
"""

import argparse
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from stages import cli
from stages.core import curve_mapping, head_angles
from stages.files import atomic, errors, live_link_writer, rig, shape_names, weights

STILL = 1e-6


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument("--names", required=True, help="table of the shapes' names")
    parser.add_argument("--livelink", required=True, help="livelink.csv to write")
    return parser


def _sources(
    path: str, names: Sequence[str], table: Sequence[shape_names.Shape]
) -> list[list[int]]:
    """Return the rig's shapes that each channel is made of."""
    plain = [name.partition(".")[2] for name in names]
    spelt = [shape_names.spelt(shape, plain) for shape in table]
    sources = [[row for row, name in enumerate(plain) if name in found] for found in spelt]
    if not any(sources):
        message = f"none of its {len(names)} shapes has a name that Live Link knows, the first is"
        message += f" '{names[0]}': take livelink out of the character's outputs, or rename them"
        raise errors.InputError(path, message)
    return sources


def _report(
    options: argparse.Namespace,
    table: Sequence[shape_names.Shape],
    sources: Sequence[Sequence[int]],
    names: Sequence[str],
    played: weights.Weights,
) -> None:
    """Log what the rig lacks and what the format does."""
    lacking = [shape.name for shape, own in zip(table, sources, strict=True) if not own]
    if lacking:
        cli.logger.info("0, because the rig lacks them: %s", ", ".join(lacking))
    used = {row for own in sources for row in own}
    left = [names[row] for row in range(len(names)) if row not in used]
    if left:
        cli.logger.warning("%s leaves out: %s", options.livelink, ", ".join(left))
    if np.ptp(played.translation, axis=0).max() > STILL or np.ptp(played.scale) > STILL:
        cli.logger.info("the head's shift and scale are left out, the format has none")


def main(argv: Sequence[str]) -> None:
    """Read weights and names, gather the channels, write them."""
    options = build_parser().parse_args(argv)
    names = rig.read_any(options.rig).names
    played = weights.read(options.weights, names)
    table = shape_names.read(options.names)
    spelt = [shape.spellings["livelink"][:1] for shape in table]
    if not all(spelt):
        bare = next(shape.name for shape, name in zip(table, spelt, strict=True) if not name)
        raise errors.InputError(options.names, f"{bare} has no name in livelink: fill it in")
    sources = _sources(options.rig, names, table)
    _report(options, table, sources, names, played)
    curves = curve_mapping.apply(played.shapes, sources)
    lengths = np.linalg.norm(played.rotation, axis=1, keepdims=True)
    head = head_angles.from_quaternions(played.rotation / lengths)
    times = [Fraction(int(n)) / played.rate + played.midnight_s for n in played.frame]
    channels = [name for (name,) in spelt]
    with atomic.replacing(options.livelink) as temporary:
        live_link_writer.write(temporary, channels, times, curves, head)


if __name__ == "__main__":
    cli.run_stage(main)
