"""Write a character that is posed at the extremes of layers: neutral, poses and masks."""

from typing import NamedTuple

import numpy as np

from data_example.generator import ply_writer

MASKS = ("upper", "mouth", "eyes")


class Played(NamedTuple):
    """A character with all of its poses, in one order of vertices.

    name : folder name
    neutral : (V, 3) float array
    poses : dict, `<layer>_<name>` -> (V, 3) float array
    faces : (F, 4) int array, counter-clockwise from outside
    colours : (V, 3) float array, 0..1
    masks : (3, V) float array of hundredths, sums of one, rows as MASKS
    digits : int, digits after the point in its files
    row : dict, its cells of characters.tsv
    """

    name: str
    neutral: np.ndarray
    poses: dict
    faces: np.ndarray
    colours: np.ndarray
    masks: np.ndarray
    digits: int
    row: dict


def masks_table(masks):
    """Return the text of the masks table by vertices."""
    lines = ["vertex\tregion\tweight"]
    for region, weights in zip(MASKS, masks, strict=True):
        lines += [f"{v}\t{region}\t{weights[v]:g}" for v in np.flatnonzero(weights > 0)]
    return "\n".join(lines) + "\n"


def write(folder, played):
    """Write a character into its folder; what moves less than a digit does not move at all."""
    (folder / "poses").mkdir(parents=True, exist_ok=True)
    rest = np.round(played.neutral, played.digits)
    mesh = ply_writer.data(played.name, rest, played.faces, played.colours)
    (folder / "neutral.ply").write_bytes(mesh)
    for name, vertices in played.poses.items():
        mesh = ply_writer.data(played.name, np.round(vertices, played.digits), played.faces)
        (folder / "poses" / f"{name}.ply").write_bytes(mesh)
    (folder / "masks.tsv").write_text(masks_table(played.masks), encoding="utf-8")
