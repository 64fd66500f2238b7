"""Write a take for Blender: a script that sets shape keys by their names, and the head."""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.files import atomic, rig, take, take_script


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument(
        "--template", required=True, help="apply_in_blender.py, the script's template"
    )
    parser.add_argument("--script", required=True, help="blender.py to write")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the take, write the script."""
    options = build_parser().parse_args(argv)
    played = take.read(options.rig, options.weights)
    character, motion = played.character, played.motion
    head = np.column_stack([motion.rotation, motion.scale, motion.translation])
    data = {
        "fps_num": played.rate.numerator,
        "fps_den": played.rate.denominator,
        "first_frame": int(played.frame[0]),
        "last_frame": int(played.frame[-1]),
        "unit": character.unit,
        "up_axis": character.up_axis,
        "vertex_hash": rig.vertex_hash(character),
        "pivot": character.pivot.tolist(),
        "curves": take_script.curves(character.names, played.frame, motion.weights),
        "head": [[float(f"{value:.9g}") for value in row] for row in head],
        **played.start,
    }
    with atomic.replacing(options.script) as temporary:
        take_script.write(temporary, options.template, data)


if __name__ == "__main__":
    cli.run_stage(main)
