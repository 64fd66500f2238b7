"""Put a character's sculpts, masks and units together into a rig; refuse gaps."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages import cli
from stages.core import local_shapes
from stages.files import character_masks, errors, key_shapes, rig, sculpts


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--key-shapes", required=True, help="key_shapes.parquet of the actor")
    parser.add_argument("--neutral", required=True, help="the neutral: .obj, .ply or .csv")
    parser.add_argument("--sculpts", nargs="*", default=[], help="the sculpts that exist, if any")
    parser.add_argument("--sculpt-folder", required=True, help="<this>/<region>/<key shape>.<ext>")
    parser.add_argument("--masks", required=True, help="masks table of the character")
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


def _wanted(
    options: argparse.Namespace, regions: list[str], values: np.ndarray
) -> list[tuple[str, str, Path]]:
    """Return region, key shape and path of every sculpt that the rig needs."""
    held = dict(zip(regions, values.any(axis=1), strict=True))
    wanted = []
    for shape in key_shapes.read(options.key_shapes):
        if shape.region not in held:
            message = f"region {shape.region} of the key shapes is not in it: add its rows"
            raise errors.InputError(options.masks, message)
        if held[shape.region]:
            path = sculpts.path_of(
                options.sculpt_folder, shape.region, shape.key_shape, options.neutral
            )
            wanted.append((shape.region, shape.key_shape, path))
    if not wanted:
        raise errors.InputError(options.masks, "no region moves a vertex: give one some weight")
    return wanted


def _refuse_gaps(options: argparse.Namespace, wanted: list[tuple[str, str, Path]]) -> None:
    """Fail if a sculpt is missing: a gap is never filled with the neutral."""
    listed = {Path(path) for path in options.sculpts}
    missing = [path for *_, path in wanted if path not in listed]
    if missing:
        brief = Path(options.key_shapes).parent / "brief"
        message = f"{len(missing)} of {len(wanted)} sculpts missing, the first is {missing[0]}"
        raise errors.InputError(options.sculpt_folder, f"{message}, see the brief at {brief}")


def main(argv: Sequence[str]) -> None:
    """Read everything, check it, write the rig."""
    options = build_parser().parse_args(argv)
    pivot = rig.pivot("--pivot", options.pivot)
    neutral = sculpts.read_neutral(options.neutral)
    regions, values = character_masks.from_table(options.masks, neutral)
    wanted = _wanted(options, regions, values)
    _refuse_gaps(options, wanted)
    deltas = local_shapes.gather(
        sculpts.read_sculpt(path, neutral)[0] - neutral.coordinates for *_, path in wanted
    )
    result = rig.Rig(
        names=[f"{region}.{shape}" for region, shape, _ in wanted],
        mask_names=regions,
        controls=neutral.names if neutral.is_controls else [],
        neutral=neutral.coordinates,
        deltas=deltas,
        masks=values,
        mask_index=np.array([regions.index(region) for region, _, _ in wanted], np.int32),
        sizes=neutral.sizes,
        corners=neutral.corners,
        colours=neutral.colours,
        pivot=pivot,
        unit=options.unit,
        up_axis=options.up_axis,
        face_unit=options.face_unit,
    )
    files = [options.key_shapes, options.neutral, options.masks, *(path for *_, path in wanted)]
    rig.write(options.rig, result, files)


if __name__ == "__main__":
    cli.run_stage(main)
