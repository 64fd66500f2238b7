"""Put the shapes of an existing blendshape rig, a mesh each or a GLB of all, together into a rig.

A shape is called after its file, or by the name that a GLB file gives its morph target; a single
mask, `face`, gives each the whole mesh.
"""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages import cli
from stages.core import local_shapes
from stages.files import errors, glb_rig, rig, sculpts

MASK = "face"


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--neutral", required=True, help="the neutral: .obj, .ply, .csv or .glb")
    parser.add_argument("--shapes", nargs="*", default=[], help="one file of its kind per shape")
    parser.add_argument("--shape-folder", required=True, help="where the shapes are expected")
    parser.add_argument("--unit", required=True, choices=sorted(rig.METRES), help="of the files")
    parser.add_argument("--up-axis", required=True, choices=["y", "z"], help="of the files")
    parser.add_argument(
        "--pivot", required=True, help="where the head turns: 'x y z' in the character's unit"
    )
    parser.add_argument(
        "--face-unit", required=True, type=float, help="one face unit, in the character's unit"
    )
    parser.add_argument("--rig", required=True, help="rig.npz to write")
    return parser


def _names(paths: Sequence[str], folder: str) -> list[str]:
    """Return the shapes' names; refuse a folder without any, and names that break columns."""
    if not paths:
        raise errors.InputError(folder, "holds no shape: export each shape as a mesh into it")
    names = [Path(path).stem for path in paths]
    for path, name in zip(paths, names, strict=True):
        if not re.fullmatch(r"[^.:/\s]+", name):
            message = f"'{name}' is no name of a shape: rename it without blanks, dots and colons"
            raise errors.InputError(path, message)
        if names.count(name) > 1:
            message = f"shape '{name}' stands in two files of this folder: remove one"
            raise errors.InputError(path, message)
    return names


def _read_files(
    options: argparse.Namespace,
) -> tuple[sculpts.Pose, list[str], local_shapes.LocalShapes]:
    """Return the neutral, names and shapes of a file each."""
    names = _names(options.shapes, options.shape_folder)
    neutral = sculpts.read_neutral(options.neutral)
    deltas = local_shapes.gather(
        sculpts.read_sculpt(path, neutral)[0] - neutral.coordinates for path in options.shapes
    )
    for path, moves in zip(options.shapes, local_shapes.touched(deltas), strict=True):
        if not moves:
            cli.logger.warning("%s: is the neutral itself, so it moves nothing", path)
    return neutral, names, deltas


def _read_glb(path: str) -> tuple[sculpts.Pose, list[str], local_shapes.LocalShapes]:
    """Return the neutral, names and shapes of one GLB file."""
    found = glb_rig.read(path)
    for note in found.notes:
        cli.logger.warning("%s: %s", path, note)
    for name, moves in zip(found.names, local_shapes.touched(found.deltas), strict=True):
        if not moves:
            cli.logger.warning("%s: %s moves nothing", path, name)
    return found.neutral, found.names, found.deltas


def main(argv: Sequence[str]) -> None:
    """Read the neutral and every shape, keep what moves, write the rig."""
    options = build_parser().parse_args(argv)
    pivot = rig.pivot("--pivot", options.pivot)
    if Path(options.neutral).suffix.lower() == ".glb":
        neutral, names, deltas = _read_glb(options.neutral)
    else:
        neutral, names, deltas = _read_files(options)
    result = rig.Rig(
        names=[f"{MASK}.{name}" for name in names],
        mask_names=[MASK],
        controls=neutral.names if neutral.is_controls else [],
        neutral=neutral.coordinates,
        deltas=deltas,
        masks=np.ones((1, len(neutral.coordinates))),
        mask_index=np.zeros(len(names), np.int32),
        sizes=neutral.sizes,
        corners=neutral.corners,
        colours=neutral.colours,
        pivot=pivot,
        unit=options.unit,
        up_axis=options.up_axis,
        face_unit=options.face_unit,
    )
    rig.write(options.rig, result, [options.neutral, *options.shapes])


if __name__ == "__main__":
    cli.run_stage(main)
