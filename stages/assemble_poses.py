"""Put a character's extremes of emotion, speech and blink under its masks into a rig.

Poses are `<layer>_<name>` and give a column `<mask>.<layer>_<name>` for every mask under which they
differ from the neutral. Where a layer has no pose of its neutral (emotion_neutral, speech_rest,
blink_open), the neutral itself stands for it. A pose that is missing is no fault here: what the
actor and the character share is found by `assemble_simplices`.

Masks are a table, or a copy of the neutral painted in red, green and blue: fill it with the pure
colour where one mask alone holds, blend where masks meet, move no vertex, export it as .ply with
linear colours. Each vertex is divided by the sum of its channels; none may be black.
"""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from stages import cli
from stages.core import local_shapes
from stages.files import character_masks, errors, extremes, pose_files, poses, rig, sculpts


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--neutral", required=True, help="the neutral: .obj, .ply or .csv")
    parser.add_argument("--poses", nargs="*", default=[], help="one file per extreme")
    parser.add_argument("--pose-folder", required=True, help="where the poses are expected")
    parser.add_argument(
        "--shapes", nargs="*", default=[], help="meshes of the blendshapes that poses may name"
    )
    parser.add_argument("--masks", required=True, help="masks table, or a painted .ply")
    parser.add_argument(
        "--painted-masks", required=True, help="masks of red, green and blue, by commas; or empty"
    )
    parser.add_argument("--extremes", required=True, help="table of all extremes")
    parser.add_argument("--unit", required=True, choices=sorted(rig.METRES), help="of the files")
    parser.add_argument("--up-axis", required=True, choices=["y", "z"], help="of the files")
    parser.add_argument(
        "--pivot", required=True, help="where the head turns: 'x y z' in the character's unit"
    )
    parser.add_argument(
        "--face-unit", required=True, type=float, help="one face unit, in the character's unit"
    )
    parser.add_argument("--rig", required=True, help="rig.npz to write")
    parser.add_argument("--poses-table", required=True, help="poses.parquet to write")
    return parser


def _shapes(paths: Sequence[str]) -> dict[str, str]:
    """Return the file of each blendshape by its name."""
    found: dict[str, str] = {}
    for path in paths:
        name = Path(path).stem
        if name in found:
            raise errors.InputError(path, f"shape '{name}' stands in two files: remove one")
        found[name] = path
    return found


def _listed(
    known: Sequence[tuple[str, str]],
    files: dict[tuple[str, str], str],
    offsets: dict[tuple[str, str], np.ndarray],
) -> list[poses.Pose]:
    """Return the row of every extreme that the character has."""
    layers = {layer for layer, _ in files}
    for layer in dict.fromkeys(layer for layer, _ in known):
        if layer not in layers:
            cli.logger.info("no pose of the layer %s: the character goes without", layer)
    rows = []
    for layer, name in known:
        if (layer, name) in files:
            moved = int(offsets[layer, name].any(axis=1).sum())
            rows.append(poses.Pose(layer, name, Path(files[layer, name]).name, moved))
        elif layer in layers and extremes.AT_REST[layer] == name:
            rows.append(poses.Pose(layer, name, poses.NEUTRAL, 0))
    return rows


def _pairs(
    masks: Sequence[str], values: np.ndarray, offsets: dict[tuple[str, str], np.ndarray]
) -> Iterator[tuple[str, int, np.ndarray]]:
    """Yield the column, the mask and the difference (V, D) of every pair that is not zero."""
    for number, (mask, weights) in enumerate(zip(masks, values, strict=True)):
        held = weights[:, None] > 0
        for extreme, offset in offsets.items():
            under = np.where(held, offset, 0.0)
            if under.any():
                yield f"{mask}.{'_'.join(extreme)}", number, under


def main(argv: Sequence[str]) -> None:
    """Read everything, check it, write the rig and the table of its extremes."""
    options = build_parser().parse_args(argv)
    pivot = rig.pivot("--pivot", options.pivot)
    known = [(row.layer, row.name) for row in extremes.read(options.extremes)]
    files = pose_files.by_name(options.poses, options.pose_folder, known)
    neutral = sculpts.read_neutral(options.neutral)
    painted = [name.strip() for name in options.painted_masks.split(",") if name.strip()]
    masks, values = character_masks.read(options.masks, painted, neutral)
    offsets = pose_files.read(files, neutral, _shapes(options.shapes))
    pairs = list(_pairs(masks, values, offsets))
    if not pairs:
        message = "no pose differs from the neutral: save the posed meshes, not copies of it"
        raise errors.InputError(options.pose_folder, message)
    result = rig.Rig(
        names=[name for name, _, _ in pairs],
        mask_names=masks,
        controls=neutral.names if neutral.is_controls else [],
        neutral=neutral.coordinates,
        deltas=local_shapes.gather(delta for _, _, delta in pairs),
        masks=values,
        mask_index=np.array([mask for _, mask, _ in pairs], np.int32),
        sizes=neutral.sizes,
        corners=neutral.corners,
        colours=neutral.colours,
        pivot=pivot,
        unit=options.unit,
        up_axis=options.up_axis,
        face_unit=options.face_unit,
    )
    sources = [options.neutral, options.masks, options.extremes, *files.values(), *options.shapes]
    rig.write(options.rig, result, sources)
    poses.write(options.poses_table, _listed(known, files, offsets), sources)


if __name__ == "__main__":
    cli.run_stage(main)
