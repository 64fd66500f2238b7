"""Write the clay head: neutral and shapes as PLY, virtual markers, channels, pairs, poses."""

import numpy as np
from scipy import interpolate, optimize

from data_example.generator import (
    clay,
    clay_poses,
    clay_rig,
    clay_shapes,
    extreme_files,
    markers,
    ply_writer,
    tuned_pairs,
)

COMMENT = "clay"
# the same places on Ada's face and on the clay head, in the frontal plane [mm]; left side
ALIKE = {
    (0, 54): (0, 72), (0, 24): (0, 36), (0, 11): (0, 18), (0, -38): (0, -22), (0, -57): (0, -42),
    (0, -67): (0, -53), (0, -75.5): (0, -68), (0, -84.5): (0, -78), (0, -102): (0, -88),
    (0, -109): (0, -94), (28, 49): (34, 68), (15, 24.5): (16, 41), (32.5, 29): (38, 49),
    (51, 25): (57, 41), (60, 15): (70, 24), (63, -3): (74, 0), (54, 1): (64, 6),
    (31.5, 10.3): (35, 20), (32, -16.5): (35, -17), (13, -44): (13, -26), (28.5, -68.4): (39, -57),
    (17, -67.2): (22, -53.5), (17, -73.2): (22, -65), (21, -81.5): (28, -74),
    (12, -101): (15, -87), (21, -95): (27, -84), (32, -87): (44, -78), (55, -66): (68, -60),
    (54, -40): (70, -36), (28, -40): (32, -30), (24, -27): (24, -21),
}  # fmt: skip
CHANNELS = """
eyeBlinkLeft 1 0 0 1 0.2 blink
eyeBlinkRight 1 0 0 1 0.2 blink
jawOpen 1 0 0 1 0.7 closure
mouthClose 1 0 0 1 0.5 closure
mouthPressLeft 1 0 0 0.9 1 closure
mouthPressRight 1 0 0 0.9 1 closure
eyeLookUpLeft 1 0 0 1 0.5 -
eyeLookUpRight 1 0 0 1 0.5 -
eyeLookDownLeft 1 0 0 1 0.5 -
eyeLookDownRight 1 0 0 1 0.5 -
"""


def ply(rig, vertices, coloured):
    """Return a mesh of the clay head as the bytes of a binary PLY."""
    return ply_writer.data(COMMENT, vertices, rig.faces, rig.colours if coloured else None)


def virtual_markers(rig):
    """Return the vertex of the clay head that stands for each marker, name -> vertex.

    A thin plate through what is alike carries the places over; no two markers share a vertex.
    """
    sides = np.array([[1, 1], [-1, 1]])
    pairs = {
        tuple(way * np.array(k, float)): way * np.array(v, float)
        for k, v in ALIKE.items()
        for way in (sides if k[0] else sides[:1])
    }
    warp = interpolate.RBFInterpolator(np.array(list(pairs)), np.stack(list(pairs.values())))
    places = [markers.MIDDLE[name] for name in markers.MIDDLE]
    places += [np.array(markers.SIDE[name]) * [out, 1] for name in markers.SIDE for out in (-1, 1)]
    wanted = warp(np.array(places, float))
    free = _outer_skin(rig)
    on = rig.neutral[free, :2] * 10
    cost = np.linalg.norm(wanted[:, None] - on, axis=2) ** 2
    rows, columns = optimize.linear_sum_assignment(cost)
    return {markers.NAMES[r]: int(free[c]) for r, c in zip(rows, columns, strict=True)}


def _outer_skin(rig):
    """Return the vertices of skin that a marker could be glued to, in front and outside, (N,)."""
    hidden = np.zeros(rig.skin, bool)
    # the mouth's rings before the lips' inner edge, the lids' before the edge
    hidden[: clay.INNER * clay.RINGS] = True
    start = (clay.INNER + 5) * clay.RINGS
    for _ in range(2):
        hidden[start : start + clay.LIDS] = True
        start += 6 * clay.LIDS
    return np.flatnonzero(~hidden & (rig.neutral[: rig.skin, 2] > 1.0))


def _table(rows):
    """Return the text of a tab-separated table."""
    return "\n".join("\t".join(row) for row in rows) + "\n"


def write_all(folder):
    """Write the clay head into its folder."""
    rig = clay_rig.build()
    (folder / "shapes").mkdir(parents=True, exist_ok=True)
    (folder / "pairs").mkdir(parents=True, exist_ok=True)
    (folder / "neutral.ply").write_bytes(ply(rig, rig.neutral, coloured=True))
    for name in clay_shapes.NAMES:
        shape = rig.neutral + rig.deltas[name]
        (folder / "shapes" / f"{name}.ply").write_bytes(ply(rig, shape, coloured=False))
    rows = [("point", "vertex"), *((n, str(v)) for n, v in virtual_markers(rig).items())]
    (folder / "virtual_markers.tsv").write_text(_table(rows), encoding="utf-8")
    header = ("shape", "gain", "offset", "low", "high", "smoothing", "keep")
    cells = [line.replace(" -", " ").split(" ") for line in CHANNELS.strip().splitlines()]
    (folder / "channels.tsv").write_text(_table([header, *cells]), encoding="utf-8")
    _write_poses(rig, folder)
    for animator, pairs in tuned_pairs.by_animator().items():
        header = ("shot", "frame", *clay_shapes.NAMES)
        text = _table([header, *pairs])
        (folder / "pairs" / f"{animator}.tsv").write_text(text, encoding="utf-8")


def _write_poses(rig, folder):
    """Write the masks, and the extremes of the layers as tables of shapes."""
    (folder / "poses").mkdir(exist_ok=True)
    masks = extreme_files.masks_table(clay_poses.masks(rig))
    (folder / "masks.tsv").write_text(masks, encoding="utf-8")
    for name, pose in clay_poses.all_poses().items():
        lines = ["name,value", *(f"{shape},{weight:g}" for shape, weight in pose.items())]
        path = folder / "poses" / f"{name}.csv"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
