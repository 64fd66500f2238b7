"""Put the tortoise together: pieces in a fixed order, quads, colours, painted masks, its poses."""

from typing import NamedTuple

import numpy as np

from data_example.generator import fields, modelling, tortoise
from data_example.generator import tortoise_parts as parts

SKIN, CROWN, PALE = (0.55, 0.60, 0.36), (0.43, 0.50, 0.29), (0.80, 0.76, 0.52)
HORN, HORN_EDGE, FLESH = (0.84, 0.71, 0.42), (0.55, 0.40, 0.22), (0.42, 0.10, 0.11)
DARK = (0.16, 0.04, 0.05)
LID, LID_EDGE, RIDGE = (0.60, 0.63, 0.38), (0.20, 0.21, 0.12), (0.24, 0.26, 0.14)
PUPIL, IRIS, IRIS_RIM, WHITE = (
    (0.04, 0.03, 0.03),
    (0.88, 0.58, 0.14),
    (0.42, 0.24, 0.06),
    (0.97, 0.95, 0.88),
)
SCUTE, SEAM, BELLY = (0.78, 0.54, 0.26), (0.34, 0.21, 0.12), (0.88, 0.76, 0.47)
TONGUE = (0.88, 0.46, 0.44)


class Tortoise(NamedTuple):
    """The tortoise, in centimetres.

    pose : function from a dict of parameters to (V, 3) float array
    faces : (F, 4) int array
    colours : (V, 3) float array, 0..1
    masks : (3, V) float array, rows extreme_files.MASKS, a partition of unity
    slices : dict, piece -> slice of its vertices
    """

    pose: object
    faces: np.ndarray
    colours: np.ndarray
    masks: np.ndarray
    slices: dict


def _pieces(rest, p):
    """Return all pieces, name -> (N, 3) [cm]."""
    skin = tortoise.skin(rest, p)
    result = {"skin": skin}
    for name, out in parts.SIDES:
        result[f"ball_{name}"] = parts.ball(out, p)
        result[f"glint_{name}"] = parts.glint(out, p)
        result[f"lid_{name}"] = parts.lids(name, out, p)
        result[f"ridge_{name}"] = parts.ridge(name, out, p)
        result[f"nose_{name}"] = tortoise.nose(skin, int(out))
    return result | {"tongue": parts.tongue(p), "shell": parts.shell(p)}


def _faces(rest):
    """Return the quads of each piece or kind of piece, outside counter-clockwise."""
    rows = len(parts.BALL_ANGLES)
    pole = parts.pole_quads(parts.SPOKES, rows * parts.SPOKES)
    ball = modelling.flipped(parts.closed_quads(rows, parts.SPOKES))
    return {
        "skin": modelling.flipped(parts.closed_quads(rest.rows, tortoise.COLUMNS, True)),
        "ball": ball + pole,
        "glint": [(0, 1, 2, 3)],
        "lid": modelling.flipped(parts.closed_quads(parts.LID_ROWS, parts.LIDS)),
        "ridge_l": modelling.grid(parts.RIDGE_ROWS, parts.RIDGE),
        "ridge_r": modelling.flipped(modelling.grid(parts.RIDGE_ROWS, parts.RIDGE)),
        "nose": [(i, i + 1, 4 - i, 5 - i) for i in range(2)],
        "tongue": modelling.flipped(modelling.grid(*parts.TONGUE)),
        "shell": modelling.flipped(
            parts.closed_quads(len(parts.SHELL), parts.SHELL_COLUMNS, True, True)
        ),
    }


def _mix(colour, other, share):
    """Return colours moved towards another by a share of each vertex, (N, 3)."""
    return colour + np.asarray(share)[:, None] * (np.asarray(other) - colour)


def _skin_colours(rest, seed):
    """Return the colours of the skin's vertices, (N, 3)."""
    table = rest.table
    colour = np.tile(SKIN, (table[0].size // 3 * len(table), 1))
    v = table.reshape(-1, 3)
    rng = np.random.default_rng(seed)
    colour = _mix(colour, CROWN, 0.9 * fields.smoothstep(3.0, 7.0, v[:, 1]))
    low = np.repeat(fields.smoothstep(0.15, 0.85, -tortoise.HIGH)[None], len(table), axis=0)
    colour = _mix(colour, PALE, 0.85 * low.ravel())
    deep = np.clip(-tortoise.WRINKLE / 0.32, 0, 1)[:, None] * np.ones(tortoise.COLUMNS)
    colour = _mix(colour, CROWN, 0.75 * deep.ravel())
    spots = np.clip(rng.normal(0.1, 0.25, len(v)), 0, 1) * fields.smoothstep(0, 5, v[:, 1])
    colour = _mix(colour, (0.30, 0.36, 0.20), spots)
    cheek = fields.bell(np.abs(v), (6.4, 0.6, 3.6), (2.2, 1.6, 2.6))
    colour = _mix(colour, (0.86, 0.56, 0.38), 0.55 * cheek)
    colour = colour.reshape(*table.shape)
    colour[0] = HORN
    colour[1] = _mix(colour[1], HORN, np.where(tortoise.LOWER, 0.15, 0.5))
    mouth = np.stack([np.tile(c, (tortoise.COLUMNS, 1)) for c in (DARK, DARK, FLESH, DARK)])
    mouth[tortoise.EDGE] = np.where(tortoise.LOWER[:, None], (0.34, 0.20, 0.10), HORN_EDGE)
    rim = np.where(tortoise.LOWER[:, None], (0.62, 0.46, 0.25), (0.40, 0.25, 0.12))[None]
    return np.concatenate([mouth, rim, colour]).reshape(-1, 3)


def _shell_colours():
    """Return the colours of the shell's vertices: dark inside, scutes, a yellow belly, (N, 3)."""
    count = parts.SHELL_COLUMNS
    turn = np.arange(count)
    seam = np.where(turn % 2, 0.9, 0.0)
    below = fields.smoothstep(0.1, 0.5, -np.cos(2 * np.pi * turn / count))
    rows = []
    for row in range(len(parts.SHELL)):
        if row < 3:
            rows.append(np.tile((0.12, 0.08, 0.06), (count, 1)))
            continue
        tone = np.tile(SEAM if row in (3, 5, 7) else SCUTE, (count, 1))
        if row not in (3, 5):
            tone = _mix(tone, SEAM, seam)
        rows.append(_mix(tone, BELLY, 0.95 * below))
    return np.concatenate(rows)


def _colours(rest, seed):
    """Return the colours of each kind of piece."""
    ball = np.repeat([PUPIL, IRIS, IRIS_RIM, WHITE, WHITE], parts.SPOKES, axis=0)
    lid = np.repeat([LID_EDGE, LID_EDGE, LID, LID, CROWN, CROWN], parts.LIDS, axis=0)
    ridge = np.repeat([LID, RIDGE, (0.33, 0.35, 0.19), RIDGE, CROWN], parts.RIDGE, axis=0)
    return {
        "skin": _skin_colours(rest, seed),
        "ball": np.concatenate([ball, [PUPIL]]),
        "glint": (1.0, 1.0, 1.0),
        "lid": lid,
        "ridge": ridge,
        "nose": (0.16, 0.12, 0.08),
        "tongue": TONGUE,
        "shell": _shell_colours(),
    }


def _masks(rest, neutral, slices):
    """Return the masks of all vertices, (3, V): what is painted red, green and blue."""
    below = np.zeros(len(neutral))
    v = rest.table.reshape(-1, 3)
    # the seam runs under the eyes over the nose, and where the throat becomes the neck
    share = fields.smoothstep(5.2, 1.2, v[:, 1] - 0.10 * np.maximum(v[:, 2] - 5.0, 0))
    share *= fields.smoothstep(-4.0, 2.5, v[:, 2]) * fields.smoothstep(-11.5, -6.5, v[:, 1])
    count = tortoise.MOUTH * tortoise.COLUMNS
    below[slices["skin"]] = np.concatenate([np.ones(count), share])
    eyes = np.zeros(len(neutral))
    for name, out in parts.SIDES:
        for piece in ("ball", "glint", "lid"):
            eyes[slices[f"{piece}_{name}"]] = 1.0
        # the corners of the mouth are near the eyes, and none of theirs
        away = np.linalg.norm((v - [out * 4.9, 4.9, 4.0]) / [3.2, 2.6, 3.6], axis=1)
        near = np.concatenate([np.zeros(count), fields.smoothstep(1.6, 0.6, away)])
        eyes[slices["skin"]] = np.maximum(eyes[slices["skin"]], near)
    below[slices["tongue"]] = 1.0
    # a nostril goes with the two vertices of skin that it lies on
    for name, out in parts.SIDES:
        first, second, share = tortoise.under_nose(int(out))
        for mask in (below, eyes):
            mask[slices[f"nose_{name}"]] = (1 - share) * mask[first] + share * mask[second]
    mouth = below * (1 - eyes)
    return np.stack([1 - mouth - eyes, mouth, eyes])


def build(seed=43):
    """Build the tortoise.

    Parameters
    ----------
    seed : int, of the spots on its head

    Returns
    -------
    character : Tortoise
    """
    rest = tortoise.Rest()
    neutral = _pieces(rest, tortoise.pose_of())
    faces, colours = _faces(rest), _colours(rest, seed)
    pieces = modelling.Pieces()
    for name, piece in neutral.items():
        kind = name.partition("_")[0]
        pieces.add(name, len(piece), faces.get(name) or faces[kind], colours[kind])

    def pose(p):
        return np.concatenate(list(_pieces(rest, p).values()))

    neutral = np.concatenate(list(neutral.values()))
    masks = _masks(rest, neutral, pieces.slices)
    tones = np.concatenate(pieces.colours)
    return Tortoise(pose, np.array(pieces.faces), tones, masks, pieces.slices)
