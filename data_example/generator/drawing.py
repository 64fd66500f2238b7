"""Draw the flat character: an ink drawing of a boy, cut out of layers of paper, in inches."""

import numpy as np

from data_example.generator import features, modelling

INK = (0.13, 0.11, 0.16)
PAPER = (0.98, 0.87, 0.74)
LAYER = 0.012
GAINS = features.Gains(jaw=1.05, corner=0.2, lift=0.28, drop=0.28, up=0.42, out=0.30)
MOUTH = np.array([0.0, -1.62])
MOUTH_HALF = 1.05
EYE = {"r": np.array([-1.02, 0.0]), "l": np.array([1.02, 0.0])}
EYE_SIZE = np.array([0.74, 0.86])
# middle of the root and tip of each tuft of hair
TUFTS = (
    (-1.9, 2.3, -3.1, 3.3),
    (-1.1, 2.8, -1.7, 4.3),
    (-0.2, 3.0, -0.1, 4.6),
    (0.8, 2.9, 1.5, 4.2),
    (1.7, 2.5, 2.9, 3.5),
)
S = np.linspace(-1, 1, 15)


def _outline(p):
    """Return the line of the head; the chin drops with the jaw, (40, 2)."""
    line = modelling.circle(40, 2.75, 3.05, -np.pi / 2) + np.array([0, -0.05])
    chin = np.clip((-0.9 - line[:, 1]) / 2.2, 0, 1)
    line[:, 1] -= 0.75 * p["jaw_open"] * chin
    line[:, 0] += (0.22 * p["jaw_side"]) * chin
    return line


def _eye_pieces(p, side):
    """Return the pieces of one eye in the order of layers, name -> (N, 3)."""
    centre, (w, h) = EYE[side], EYE_SIZE
    ring = modelling.circle(18, w, h) + centre
    closed = np.concatenate([ring, ring[:1]])
    look = np.array([0.30 * p["gaze_x"], 0.32 * p["gaze_y"]])
    glint = modelling.circle(6, 0.10) + centre + look + [0.11, 0.13]
    pupil = modelling.circle(14, 0.33, 0.37) + centre + look
    high, low = features.lid_heights(p, side, 0.80, -0.97, -0.42)
    u = np.linspace(-0.999, 0.999, 11)
    arc = np.sqrt(1 - u * u)
    x = centre[0] + 1.03 * w * u
    edge, base = centre[1] + h * high * arc, centre[1] + h * low * arc
    top, bottom = centre[1] + 1.03 * h * arc, centre[1] - 1.03 * h * arc
    upper = np.concatenate([np.stack([x, edge], 1), np.stack([x, top], 1)])
    lower = np.concatenate([np.stack([x, bottom], 1), np.stack([x, base], 1)])
    lash = modelling.ribbon(np.stack([x, edge], 1), 0.13)
    return {
        "white": modelling.raised(np.vstack([ring, centre]), 3 * LAYER),
        "pupil": modelling.raised(np.vstack([pupil, centre + look]), 4 * LAYER),
        "glint": modelling.raised(np.vstack([glint, glint.mean(axis=0)]), 5 * LAYER),
        "lidlow": modelling.raised(lower, 6 * LAYER),
        "lidup": modelling.raised(upper, 7 * LAYER),
        "lash": modelling.raised(lash, 8 * LAYER),
        "rim": modelling.raised(modelling.ribbon(closed, 0.11), 9 * LAYER),
    }


def _mouth_pieces(p):
    """Return the pieces of the mouth in the order of layers, name -> (N, 3)."""
    upper, lower = features.lips(p, S, GAINS)
    bow = np.stack([0 * S, 0.13 * S**2], axis=1)
    upper, lower = MOUTH + MOUTH_HALF * (upper + bow), MOUTH + MOUTH_HALF * (lower + bow)
    gap = upper[:, 1] - lower[:, 1]
    bite = upper - np.stack([0 * gap, np.minimum(0.34 * gap, 0.30)], 1)
    tongue = lower + np.stack([0 * gap, (0.42 + 0.3 * p["tongue_up"]) * gap * (1 - 0.5 * S**2)], 1)
    thick = 0.15 * features.fullness(p) + 0.02
    taper = 0.45 + 0.55 * (1 - S**4)
    return {
        "inside": modelling.raised(np.concatenate([lower, upper]), 3 * LAYER),
        "tongue": modelling.raised(np.concatenate([lower, tongue]), 4 * LAYER),
        "teeth": modelling.raised(np.concatenate([bite, upper]), 5 * LAYER),
        "lipup": modelling.raised(modelling.ribbon(upper, thick * taper), 7 * LAYER),
        "liplow": modelling.raised(modelling.ribbon(lower, 1.25 * thick * taper), 6 * LAYER),
    }


def _pieces(p):
    """Return all pieces, name -> (N, 3) [inch]."""
    outline = _outline(p)
    result = {"face": modelling.raised(np.vstack([outline, [0, 0]]), 0)}
    closed = np.concatenate([outline, outline[:1]])
    result["outline"] = modelling.raised(modelling.ribbon(closed, 0.14), LAYER)
    for number, (x, y, tip_x, tip_y) in enumerate(TUFTS):
        lift = 0.25 * (p["brow_outer_l"] + p["brow_outer_r"]) / 2
        tuft = [[x - 0.66, y - 0.3], [x + 0.66, y - 0.3], [tip_x, tip_y + lift]]
        result[f"tuft{number}"] = modelling.raised(np.array(tuft), 2 * LAYER)
    for side, out in (("r", -1), ("l", 1)):
        middle = np.array([out * 1.72, -1.05 + 0.16 * p[f"smile_{side}"]])
        cheek = modelling.circle(10, 0.42, 0.30) + middle
        result[f"cheek_{side}"] = modelling.raised(np.vstack([cheek, cheek.mean(0)]), LAYER)
        for name, piece in _eye_pieces(p, side).items():
            result[f"{name}_{side}"] = piece
        t = np.linspace(0, 1, 8)
        line = np.stack([out * (1.72 - 1.25 * t), 1.26 + 0.30 * np.sin(np.pi * (0.2 + 0.7 * t))], 1)
        line += 1.35 * features.brow(p, side, t)
        result[f"brow_{side}"] = modelling.raised(
            modelling.ribbon(line, 0.12 + 0.26 * np.sin(np.pi * (0.25 + 0.6 * t))), 10 * LAYER
        )
    bend = np.array([[0.02, -0.25], [0.16, -0.55], [0.22, -0.80], [0.04, -0.90], [-0.12, -0.84]])
    bend[2:, 1] += 0.07 * p["upper_up"]
    result["nose"] = modelling.raised(
        modelling.ribbon(bend, [0.05, 0.08, 0.1, 0.1, 0.05]), 2 * LAYER
    )
    return result | _mouth_pieces(p)


COLOURS = {
    "face": PAPER,
    "outline": INK,
    "tuft": (0.80, 0.36, 0.14),
    "cheek": (0.96, 0.62, 0.55),
    "white": (1, 1, 1),
    "pupil": INK,
    "glint": (1, 1, 1),
    "lid": (0.95, 0.78, 0.64),
    "lash": INK,
    "rim": INK,
    "brow": (0.45, 0.18, 0.08),
    "nose": INK,
    "inside": (0.32, 0.06, 0.09),
    "tongue": (0.88, 0.40, 0.42),
    "teeth": (1, 1, 0.97),
    "lip": (0.72, 0.20, 0.22),
}


def _mouth_share(neutral):
    """Return how much the head's line follows the mouth rather than the eyes, (N,)."""
    return np.clip((-0.1 - neutral[:, 1]) / 0.7, 0, 1)


def build(neutral):
    """Build the drawing.

    Parameters
    ----------
    neutral : dict of the neutral's expression parameters
    """
    parts = modelling.Pieces()
    start = _pieces(neutral)
    for name, vertices in start.items():
        colour = next(c for key, c in COLOURS.items() if name.startswith(key))
        if name.startswith(("face", "cheek", "white", "pupil", "glint")):
            faces = modelling.fan(len(vertices) - 1)
        elif name.startswith("tuft"):
            faces = [(0, 1, 2)]
        else:
            faces = modelling.grid(2, len(vertices) // 2)
        if name in ("brow_l", "nose"):
            faces = modelling.grid(2, len(vertices) // 2)
        parts.add(name, len(vertices), faces, colour)
    pupils = set(parts.numbers("pupil", "glint"))
    mouth = set(parts.numbers("inside", "tongue", "teeth", "lip", "cheek", "nose"))
    blend = dict.fromkeys(parts.numbers("face", "outline"))
    share = _mouth_share(np.concatenate(list(start.values())))
    rows = ["vertex\tregion\tweight"]
    for v in range(parts.count):
        weights = {"mouth": float(v in mouth), "pupils": float(v in pupils)}
        if v in blend:
            weights["mouth"] = round(float(share[v]), 3)
        weights["eyes"] = round(1 - weights["mouth"] - weights["pupils"], 3)
        rows += [f"{v}\t{region}\t{w:g}" for region, w in weights.items() if w > 0]
    row = {"unit": "inch", "up_axis": "y", "pivot": "0 -2.6 0", "face_unit": "2.04"}
    return modelling.Character(
        "drawing",
        lambda p: np.concatenate(list(_pieces(p).values())),
        parts.faces,
        np.concatenate(parts.colours),
        rows,
        4,
        row,
    )
