"""Drive a rig by recorded curves, shape by shape, through the table of names.

The rig may spell its shapes as any known package does. A shape that it splits gets the curve on
both sides, one that it shares between sides gets their mean. What the rig lacks, and how much of
the motion that is, stands in the log.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import curve_mapping
from stages.files import errors, rig, series, shape_names

START = ("start_timecode", "start_s")
LEAST = 1e-3  # standard deviation of a curve that is called a motion


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", required=True, help="curves of the shot, .parquet")
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--names", required=True, help="table of the shapes' names")
    parser.add_argument("--mapped", required=True, help="weights of the rig, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read curves and rig, find each shape's curves, write the weights."""
    arguments = build_parser().parse_args(argv)
    curves = series.read(arguments.curves, "curves")
    names = rig.read_any(arguments.rig).names
    table = [shape for shape in shape_names.read(arguments.names) if shape.name in curves.columns]
    plain = [name.partition(".")[2] for name in names]
    taken = [shape_names.spelt(shape, plain) for shape in table]
    sources = [[index for index, found in enumerate(taken) if shape in found] for shape in plain]
    if not any(sources):
        message = f"no shape of the rig has a known name, its first is {names[0]}"
        raise errors.InputError(arguments.rig, message + ": rename its shapes, as ARKit does")
    values = np.stack([curves.columns[shape.name] for shape in table], axis=1)
    _report(arguments, [shape.name for shape in table], values, taken, plain, sources)
    weights = curve_mapping.apply(values, sources)
    columns = dict(zip(names, weights.T, strict=True))
    columns["confidence"] = curves.columns["confidence"]
    kept = {name: curves.meta[name] for name in START if name in curves.meta}
    series.write(
        arguments.mapped,
        "mapped",
        curves.frame,
        curves.time_s,
        columns,
        curves.rate,
        kept,
        [arguments.curves, arguments.rig, arguments.names],
    )


def _report(
    arguments: argparse.Namespace,
    channels: Sequence[str],
    values: np.ndarray,
    taken: Sequence[Sequence[str]],
    plain: Sequence[str],
    sources: Sequence[Sequence[int]],
) -> None:
    """Log what moves nothing, and what nothing moves."""
    motion = curve_mapping.motion(values)
    lost = [index for index, found in enumerate(taken) if not found and motion[index] > LEAST]
    for index in sorted(lost, key=lambda index: -motion[index]):
        cli.logger.warning(
            "%s: has no %s, which moves by %.3f (standard deviation) and reaches %.3f",
            arguments.rig, channels[index], motion[index], np.abs(values[:, index]).max(),
        )  # fmt: skip
    share = np.sum(motion[lost] ** 2) / max(np.sum(motion**2), LEAST**2)
    cli.logger.info(
        "%d of %d moving channels drive the rig, %.1f %% of the motion's variance is lost",
        np.count_nonzero(motion > LEAST) - len(lost), np.count_nonzero(motion > LEAST), 100 * share,
    )  # fmt: skip
    idle = [name for name, own in zip(plain, sources, strict=True) if not own]
    if idle:
        cli.logger.info("shapes of the rig that no channel drives: %s", ", ".join(idle))


if __name__ == "__main__":
    cli.run_stage(main)
