"""Write a take for Maya: a script that sets keys by the targets' names, and an `.anim` file."""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import head_angles
from stages.files import atomic, maya_anim, rig, take, take_script

AXES = "XYZ"


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument("--template", required=True, help="apply_in_maya.py, the script's template")
    parser.add_argument("--script", required=True, help="maya.py to write")
    parser.add_argument("--anim", required=True, help="maya.anim to write")
    return parser


def _head(played: take.Take) -> np.ndarray:
    """Return the nine channels (T, 9) of a transform: shift, turn [degrees], scale."""
    motion = played.motion
    turns = np.unwrap(head_angles.about_fixed_axes(motion.rotation), axis=0)
    scale = np.repeat(motion.scale[:, None], 3, axis=1)
    return np.concatenate([motion.translation, np.degrees(turns), scale], axis=1)


def main(argv: Sequence[str]) -> None:
    """Read the take, write both files."""
    options = build_parser().parse_args(argv)
    played = take.read(options.rig, options.weights)
    character, frame = played.character, played.frame
    span = int(frame[0]), int(frame[-1])
    channels = [f"{move}{axis}" for move in ("translate", "rotate", "scale") for axis in AXES]
    data = {
        "time_unit": maya_anim.time_unit(options.weights, played.rate),
        "fps_num": played.rate.numerator,
        "fps_den": played.rate.denominator,
        "first_frame": span[0],
        "last_frame": span[1],
        "unit": character.unit,
        "up_axis": character.up_axis,
        "vertex_hash": rig.vertex_hash(character),
        "pivot": character.pivot.tolist(),
        "curves": take_script.curves(character.names, frame, played.motion.weights),
        "head": take_script.curves(channels, frame, _head(played)),
        **played.start,
    }
    plain = [name.replace(".", "_") for name in character.names]
    with atomic.replacing(options.script) as script, atomic.replacing(options.anim) as anim:
        take_script.write(script, options.template, data)
        maya_anim.write(anim, plain, data["curves"].values(), span, played.rate)


if __name__ == "__main__":
    cli.run_stage(main)
