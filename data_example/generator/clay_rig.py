"""Put the clay head together: pieces, faces, colours, neutral and shapes, ready to write."""

from typing import NamedTuple

import numpy as np

from data_example.generator import clay, clay_shapes, fields, modelling, params

SKIN, CHEEK, LIP = (0.90, 0.62, 0.45), (0.90, 0.45, 0.36), (0.76, 0.33, 0.28)
DARK = (0.26, 0.06, 0.07)
LIPS = (DARK, DARK, LIP, (0.82, 0.40, 0.33), (0.86, 0.53, 0.40))
HAIR, WHITE = (0.20, 0.42, 0.44), (0.98, 0.97, 0.94)
IRIS, PUPIL = (0.30, 0.55, 0.30), (0.05, 0.04, 0.05)
TOOTH, TONGUE = (0.97, 0.95, 0.88), (0.86, 0.42, 0.42)
# middle, tip and radius of each curl of hair [mm]
CURLS = (
    (0, 104, 30, 6, 148, 62, 24), (-38, 98, 18, -50, 132, 48, 21), (38, 98, 18, 54, 128, 44, 21),
    (-66, 72, -4, -90, 98, 8, 19), (66, 72, -4, 90, 96, 8, 19), (0, 108, -18, -12, 146, -16, 24),
    (-48, 88, -36, -66, 118, -46, 22), (48, 88, -36, 66, 118, -46, 22),
)  # fmt: skip


class Clay(NamedTuple):
    """The rig, in centimetres.

    neutral : (V, 3) float array
    deltas : dict, shape -> (V, 3) float array
    faces : (F, 3) int array
    colours : (V, 3) float array, 0..1
    skin : int, number of the skin's vertices, which come first
    slices : dict, piece -> slice of its vertices
    """

    neutral: np.ndarray
    deltas: dict
    faces: np.ndarray
    colours: np.ndarray
    skin: int
    slices: dict


def _ear(out):
    """Return an ear at rest, two rings and a middle, (15, 3) [mm]."""
    ring = modelling.circle(7, 14.0, 19.0, np.pi / 2)
    rows = [
        np.column_stack([x - 0.3 * k * ring[:, 0], k * ring[:, 1], k * ring[:, 0]])
        for x, k in ((0.0, 0.8), (9.0, 1.0))
    ]
    rows.append(np.array([[4.0, 0, 0]]))
    return (np.concatenate(rows) + np.array([80.0, -6.0, 2.0])) * [out, 1, 1]


def _curl(root, tip, radius):
    """Return a curl: a round root, a smaller ring on the way, a blunt tip, (15, 3) [mm]."""
    root, tip = np.array(root, float), np.array(tip, float)
    along = (tip - root) / np.linalg.norm(tip - root)
    across = np.cross(along, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    up = np.cross(along, across)
    rows = []
    for t, size in ((0.0, 1.0), (0.62, 0.78)):
        circle = modelling.circle(7, radius * size)
        rows.append(root + t * (tip - root) + circle[:, :1] * across + circle[:, 1:] * up)
    return np.concatenate([*rows, [tip]])


def _colours(rest):
    """Return the colours of the skin's vertices, (V, 3)."""
    v = rest.skin
    mirrored = np.column_stack([np.abs(v[:, 0]), v[:, 1:]])
    colour = np.tile(SKIN, (len(v), 1))
    for place, radii, strength in (
        ((52, -34, 70), (20, 15, 45), 0.75),
        ((0, -20, 98), (14, 12, 20), 0.65),
    ):
        amount = strength * fields.bell(mirrored, place, radii)
        colour = colour + amount[:, None] * (np.array(CHEEK) - colour)
    mouth, *eyes = rest.rings
    for ring, tone in zip(mouth[: len(LIPS)], LIPS, strict=True):
        colour[ring] = tone
    for rings in eyes:
        colour[rings[:2]] = (0.62, 0.36, 0.28)
        colour[rings[2]] = (0.84, 0.56, 0.42)
    return colour


def _add_ball(parts, name):
    """Add an eyeball: pupil, iris and white in rings of their own."""
    count = clay.SPOKES
    rows = len(clay.BALL_ANGLES)
    faces = modelling.flipped(modelling.grid(rows, count, closed=True))
    faces += modelling.fan(count, 0, rows * count)
    tones = [PUPIL, IRIS, (0.18, 0.36, 0.20), WHITE, (0.92, 0.86, 0.82)]
    colours = np.concatenate([np.repeat(tones, count, axis=0), [PUPIL]])
    parts.add(name, len(colours), faces, colours)


def _triangles(faces):
    """Return polygons cut into triangles, (F, 3): not every reader takes both in one file."""
    return np.array([(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)])


def build():
    """Build the rig.

    Returns
    -------
    rig : Clay
    """
    rest = clay.Rest()
    parts = modelling.Pieces()
    moving = clay.pose(rest, params.neutral())
    parts.add("skin", len(rest.skin), rest.faces, _colours(rest))
    for side in ("r", "l"):
        _add_ball(parts, f"ball_{side}")
        faces = modelling.grid(3, 8)
        parts.add(f"brow_{side}", 24, modelling.flipped(faces) if side == "l" else faces, HAIR)
    for name in ("upper", "lower"):
        parts.add(name, 18, modelling.grid(2, 9), TOOTH)
    parts.add("tongue", 15, modelling.flipped(modelling.grid(3, 5)), TONGUE)
    fixed = []
    for side, out in (("r", -1.0), ("l", 1.0)):
        faces = modelling.grid(2, 7, closed=True) + modelling.fan(7, 7, 14)
        parts.add(f"ear_{side}", 15, modelling.flipped(faces) if side == "l" else faces, SKIN)
        fixed.append(_ear(out))
    for number, (*ends, radius) in enumerate(CURLS):
        faces = modelling.grid(2, 7, closed=True) + modelling.fan(7, 7, 14)
        parts.add(f"curl{number}", 15, faces, HAIR)
        fixed.append(_curl(ends[:3], ends[3:], radius))
    still = np.concatenate(fixed)
    neutral = np.concatenate([*moving.values(), still]) / 10
    nothing = np.zeros_like(still)
    shapes = {
        name: np.concatenate([delta, nothing]) / 10
        for name, delta in clay_shapes.deltas(rest).items()
    }
    return Clay(
        neutral,
        shapes,
        _triangles(parts.faces),
        np.concatenate(parts.colours),
        len(rest.skin),
        parts.slices,
    )
