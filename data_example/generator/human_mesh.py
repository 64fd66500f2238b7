"""Dress the human character: ears, hair at the sides, colours, faces and masks."""

import numpy as np

from data_example.generator import fields, human, modelling

SKIN, NOSE, LIP = (0.87, 0.64, 0.52), (0.86, 0.44, 0.38), (0.70, 0.36, 0.34)
HAIR, WHITE, IRIS = (0.87, 0.87, 0.89), (0.96, 0.95, 0.92), (0.32, 0.50, 0.66)
DARK, TOOTH = (0.22, 0.05, 0.06), (0.93, 0.89, 0.78)
# from the throat to the border of the lips
LIPS = (DARK, DARK, (0.52, 0.22, 0.22), LIP, (0.80, 0.53, 0.45))


def _ear(side):
    """Return an ear at rest: rim, bowl and its middle, (25, 3) [mm]."""
    out = 1.0 if side == "l" else -1.0
    ring = modelling.circle(8, 15.0, 26.0, np.pi / 2)
    ring[:, 0] *= np.where(ring[:, 1] < 0, 0.75, 1.0)
    x = np.array([60.0, 78.0, 74.0])
    rows = [
        np.column_stack(
            [np.full(8, a) + 0.35 * k * ring[:, 0] * -1, k * ring[:, 1] - 14, k * ring[:, 0] - 8]
        )
        for a, k in zip(x, (0.75, 1.0, 0.62), strict=True)
    ]
    ear = np.concatenate([*rows, [[69.0, -14.0, -6.0]]])
    return ear * [out, 1, 1]


def _tuft(side):
    """Return the white hair over an ear at rest, (16, 3) [mm]."""
    out = 1.0 if side == "l" else -1.0
    z = np.array([16.0, 2, -14, -32, -52, -70, -84, -92])
    low = np.array([2.0, 16, 18, 4, -14, -26, -34, -38])
    high = np.array([22.0, 40, 46, 46, 42, 36, 30, 24])
    wide = np.array([66.0, 76, 80, 82, 78, 68, 52, 36])
    rows = [np.column_stack([wide + b, y, z - 5]) for y, b in ((low, 4), (high, -9))]
    return np.concatenate(rows) * [out, 1, 1]


def _colours(rest):
    """Return the colours of the skin's vertices, (V, 3)."""
    v = rest.skin
    mirrored = np.column_stack([np.abs(v[:, 0]), v[:, 1:]])
    colour = np.tile(SKIN, (len(v), 1))

    def mix(to, amount):
        return colour + amount[:, None] * (np.array(to) - colour)

    colour = mix(NOSE, 0.85 * fields.bell(mirrored, (0, -42, 108), (17, 15, 22)))
    colour = mix(NOSE, 0.5 * fields.bell(mirrored, (40, -45, 66), (17, 15, 40)))
    colour = mix((0.66, 0.46, 0.42), 0.6 * fields.bell(mirrored, (27, -14, 70), (17, 6, 40)))
    colour = mix(
        (0.80, 0.70, 0.62), 0.55 * fields.smoothstep(-86, -104, v[:, 1]) * (v[:, 1] > -150)
    )
    mouth, *eyes = rest.rings
    for ring, tone in zip(mouth[:5], LIPS, strict=True):
        colour[ring] = tone
    for rings in eyes:
        colour[rings[:2]] = (0.58, 0.36, 0.32)
        colour[rings[2]] = (0.83, 0.58, 0.48)
    return colour


def _masks(parts, neutral):
    """Return the rows of the masks table: mouth below, eyes above, balls the pupils."""
    only = {name: parts.numbers(key) for name, key in (("pupils", "ball"),)}
    eyes = set(parts.numbers("brow")) | set(parts.eye_rings)
    mouth = set(parts.numbers("upper", "lower")) | set(parts.mouth_rings)
    share = fields.smoothstep(-2.2, -5.0, neutral[:, 1])
    rows = ["vertex\tregion\tweight"]
    for v in range(parts.count):
        if v in only["pupils"]:
            rows.append(f"{v}\tpupils\t1")
            continue
        low = 0.0 if v in eyes else 1.0 if v in mouth else round(float(share[v]), 3)
        rows += [f"{v}\tmouth\t{low:g}"] if low > 0 else []
        rows += [f"{v}\teyes\t{1 - low:.3g}"] if low < 1 else []
    return rows


def _add_ball(parts, name):
    """Add an eyeball: pupil, iris and white in rings of their own."""
    rings = modelling.flipped(modelling.grid(6, human.SPOKES, closed=True))
    rings += modelling.fan(human.SPOKES, 0, 6 * human.SPOKES)
    tones = [(0.03, 0.03, 0.04), IRIS, (0.20, 0.32, 0.45), WHITE, WHITE, (0.85, 0.70, 0.66)]
    colours = np.concatenate([np.repeat(tones, human.SPOKES, axis=0), [tones[0]]])
    parts.add(name, len(colours), rings, colours)


def build(neutral):
    """Build the human character.

    Parameters
    ----------
    neutral : dict of the neutral's expression parameters
    """
    rest = human.Rest(neutral)
    parts = modelling.Pieces()
    parts.add("skin", len(rest.skin), rest.faces, _colours(rest))
    parts.mouth_rings = rest.rings[0][:5].ravel().tolist()
    parts.eye_rings = np.concatenate([r[:5].ravel() for r in rest.rings[1:]]).tolist()
    for side in ("r", "l"):
        _add_ball(parts, f"ball_{side}")
        faces = modelling.grid(3, 6)
        parts.add(f"brow_{side}", 18, modelling.flipped(faces) if side == "l" else faces, HAIR)
    for name in ("upper", "lower"):
        parts.add(name, 18, modelling.grid(2, 9), TOOTH)
    fixed = {}
    for side in ("r", "l"):
        ear, tuft = _ear(side), _tuft(side)
        faces = modelling.grid(3, 8, closed=True) + modelling.fan(8, 16, 24)
        parts.add(
            f"ear_{side}",
            25,
            modelling.flipped(faces) if side == "r" else faces,
            (0.85, 0.55, 0.46),
        )
        faces = modelling.grid(2, 8)
        parts.add(f"tuft_{side}", 16, modelling.flipped(faces) if side == "r" else faces, HAIR)
        fixed |= {f"ear_{side}": ear, f"tuft_{side}": tuft}

    def pose(p):
        return np.concatenate(list((human.pose(rest, p) | fixed).values())) / 10

    row = {"unit": "cm", "up_axis": "y", "pivot": "0 -14 -2.5", "face_unit": "5.4"}
    masks = _masks(parts, pose(neutral))
    return modelling.Character(
        "human", pose, parts.faces, np.concatenate(parts.colours), masks, 3, row
    )
