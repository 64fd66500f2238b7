"""Model the radio: dials for eyes, a speaker for a mouth; in metres, z up, facing -y.

It is modelled like the face, x to its left, y up, z forwards, in centimetres, then turned.
"""

import numpy as np

from data_example.generator import features, modelling

WOOD, WOOD_DARK = (0.55, 0.27, 0.13), (0.36, 0.16, 0.08)
CREAM, BRASS, CHROME = (0.93, 0.86, 0.70), (0.83, 0.62, 0.25), (0.72, 0.75, 0.78)
BLACK, RED, TEAL = (0.06, 0.05, 0.06), (0.74, 0.16, 0.15), (0.16, 0.47, 0.47)
FRONT = 5.6
GAINS = features.Gains(jaw=0.62, corner=0.12, lift=0.2, drop=0.2, up=0.26, out=0.14, narrow=0.45)
MOUTH = np.array([0.0, -5.2])
MOUTH_HALF = 6.2
EYE = {"r": np.array([-6.4, 3.4]), "l": np.array([6.4, 3.4])}
DIAL = 3.7
S = np.linspace(-1, 1, 13)
# corners of the case, of a dial, of a knob, of the aerial's ball
CASE, ROUND, KNOB, BALL = 24, 16, 10, 6


def _rounded(count, width, height, power=5.0):
    """Return points of a rounded rectangle counter-clockwise from below, (count, 2)."""
    angle = 2 * np.pi * np.arange(count) / count - np.pi / 2
    c, s = np.cos(angle), np.sin(angle)
    x = np.sign(c) * np.abs(c) ** (2 / power) * width / 2
    return np.stack([x, np.sign(s) * np.abs(s) ** (2 / power) * height / 2], axis=1)


def _chin(flat, p):
    """Return points of the case after the jaw has pulled its lower edge down, (N, 2)."""
    share = np.clip((-2.2 - flat[:, 1]) / 8.0, 0, 1) ** 1.3
    moved = flat.copy()
    moved[:, 1] -= 2.3 * p["jaw_open"] * share
    moved[:, 0] += 0.9 * p["jaw_side"] * share
    moved[:, 0] *= 1 + share * (0.05 * (p["smile_l"] + p["smile_r"]) / 2 - 0.05 * p["pucker"])
    return moved


def _case(p):
    """Return the wooden case, its front panel, feet, handle and the aerial, name -> (N, 3)."""
    rings = [(30, 20.5, FRONT - 0.15), (31.6, 22, FRONT - 0.7), (31.6, 22, -4.8), (30, 20.5, -5.4)]
    case = [modelling.raised(_chin(_rounded(CASE, w, h), p), z) for w, h, z in rings]
    back = np.array([[0.0, 0.0, -5.5]])
    panel = modelling.raised(_chin(np.vstack([_rounded(CASE, 29.4, 19.9), [0, 0]]), p), FRONT)
    result = {"case": np.concatenate([*case, back]), "panel": panel}
    for side, x in (("r", -11.0), ("l", 11.0)):
        sole = ((x - 1.5, 4), (x + 1.5, 4), (x + 1.5, -4), (x - 1.5, -4))
        box = np.array([[a, b, c] for b in (-12.2, -10.6) for a, c in sole], float)
        box[:, :2] += _chin(np.array([[x, -10.6]]), p)[0] - [x, -10.6]
        result[f"foot_{side}"] = box
    angle = np.linspace(0, np.pi, 7)
    arc = np.stack([-9.5 * np.cos(angle), 10.6 + 4.2 * np.sin(angle) ** 0.8], axis=1)
    bar = modelling.ribbon(arc[::-1], 1.0)
    result["handle"] = np.concatenate([modelling.raised(bar, z) for z in (0.8, -0.8)])
    tilt = 0.25 + 0.22 * (p["brow_outer_l"] - p["brow_frown"]) + 0.1 * p["brow_inner_l"]
    tip = np.array([12.5 + 9.0 * np.sin(tilt), 10.5 + 9.0 * np.cos(tilt)])
    rod = modelling.ribbon(np.array([[12.5, 10.2], tip]), [0.55, 0.25])
    result["aerial"] = np.concatenate([modelling.raised(rod, z) for z in (-1.8, -2.2)])
    ball = [tip + modelling.circle(BALL, r) for r in (0.35, 0.75, 0.35)]
    result["ball"] = np.concatenate(
        [modelling.raised(ring, z) for ring, z in zip(ball, (-1.4, -2.0, -2.6), strict=True)]
        + [np.array([[*tip, -1.3], [*tip, -2.7]])]
    )
    return result


def _eye(p, side):
    """Return the dial of one eye with pupil, lids and brow, name -> (N, 3)."""
    centre = EYE[side]
    bezel = [(DIAL + 0.75, FRONT + 0.05), (DIAL + 0.4, FRONT + 0.75), (DIAL - 0.1, FRONT + 0.3)]
    rim = [modelling.raised(modelling.circle(ROUND, r) + centre, z) for r, z in bezel]
    white = modelling.raised(
        np.vstack([modelling.circle(ROUND, DIAL), [0, 0]]) + centre, FRONT + 0.2
    )
    look = np.array([1.55 * p["gaze_x"], 1.35 * p["gaze_y"]])
    iris = modelling.circle(12, 1.85) + centre + look
    pupil = modelling.circle(10, 1.05) + centre + look
    glint = modelling.circle(5, 0.36) + centre + look + [-0.55, 0.6]
    high, low = features.lid_heights(p, side, 0.70, -0.93, -0.34)
    u = np.linspace(-0.999, 0.999, 9)
    arc = DIAL * np.sqrt(1 - u * u)
    x = centre[0] + DIAL * u
    rows = [(low, FRONT + 0.62), ((low - 1) / 2, FRONT + 0.55), (-1.0, FRONT + 0.4)]
    lower = [modelling.raised(np.stack([x, centre[1] + t * arc], 1), z) for t, z in rows[::-1]]
    rows = [(high, FRONT + 0.85), (0.55 * high + 0.45, FRONT + 0.8), (1.0, FRONT + 0.45)]
    upper = [modelling.raised(np.stack([x, centre[1] + t * arc], 1), z) for t, z in rows]
    lash = modelling.ribbon(np.stack([x, centre[1] + high * arc], 1), 0.34)
    t = np.linspace(0, 1, 6)
    out = 1 if side == "l" else -1
    line = centre + np.stack(
        [out * (3.6 - 6.6 * t), 4.9 + 0.7 * np.sin(np.pi * (0.15 + 0.7 * t))], 1
    )
    line += 6.2 * features.brow(p, side, t)
    brow = [
        modelling.raised(modelling.ribbon(line, w), z)
        for w, z in ((1.25, FRONT + 0.1), (0.7, FRONT + 0.9))
    ]
    outer, inner = brow
    strip = np.concatenate([outer[:6], inner[:6], inner[6:], outer[6:]])
    return {
        "rim": np.concatenate(rim),
        "white": white,
        "iris": modelling.raised(np.vstack([iris, centre + look]), FRONT + 0.32),
        "pupil": modelling.raised(np.vstack([pupil, centre + look]), FRONT + 0.42),
        "glint": modelling.raised(np.vstack([glint, glint.mean(axis=0)]), FRONT + 0.52),
        "lidlow": np.concatenate(lower),
        "lidup": np.concatenate(upper),
        "lash": modelling.raised(lash, FRONT + 0.97),
        "brow": strip,
    }


def _mouth(p):
    """Return the speaker: hollow, teeth like keys, and its rim as lips, name -> (N, 3)."""
    upper, lower = features.lips(p, S, GAINS)
    bow = np.stack([0 * S, 0.12 * S**2], axis=1)
    upper, lower = MOUTH + MOUTH_HALF * (upper + bow), MOUTH + MOUTH_HALF * (lower + bow)
    gap = upper[:, 1] - lower[:, 1]
    keys = upper - np.stack([0 * gap, np.minimum(0.36 * gap, 1.5)], 1)
    tongue = lower + np.stack([0 * gap, (0.38 + 0.3 * p["tongue_up"]) * gap * (1 - 0.6 * S**2)], 1)
    push = 1.4 * features.forward(p)
    full = features.fullness(p) * (0.35 + 0.65 * (1 - S**4))
    result = {
        "hollow": modelling.raised(np.concatenate([lower, upper]), FRONT + 0.12),
        "tongue": modelling.raised(np.concatenate([lower, tongue]), FRONT + 0.22),
        "keys": modelling.raised(np.concatenate([keys, upper]), FRONT + 0.32),
    }
    for name, line, sign, thick in (("lipup", upper, 1, 1.0), ("liplow", lower, -1, 1.25)):
        rows = []
        for share, z in ((-0.10, 0.35), (0.45, 1.15), (1.0, 0.05)):
            away = sign * thick * full * share
            rows.append(modelling.raised(line + np.stack([0 * away, away], 1), FRONT + z + push))
        result[name] = np.concatenate(rows if sign > 0 else rows[::-1])
    return result


def _scale(p):
    """Return the tuning scale with its needle and the knobs, name -> (N, 3)."""
    glass = np.array([[-7.5, -1.9], [7.5, -1.9], [-7.5, -1.2], [7.5, -1.2]])
    x = 6.0 * p["gaze_x"]
    needle = np.array([[x - 0.2, -2.0], [x + 0.2, -2.0], [x - 0.2, -1.1], [x + 0.2, -1.1]])
    result = {
        "scale": modelling.raised(glass, FRONT + 0.1),
        "needle": modelling.raised(needle, FRONT + 0.2),
    }
    for side, at in (("r", -11.6), ("l", 11.6)):
        lift = 0.7 * p[f"smile_{side}"]
        centre = _chin(np.array([[at, -5.2]]), p)[0] + [0, lift]
        rings = [(1.7, FRONT + 0.05), (1.55, FRONT + 1.2)]
        knob = [modelling.raised(modelling.circle(KNOB, r) + centre, z) for r, z in rings]
        result[f"knob_{side}"] = np.concatenate([*knob, [[*centre, FRONT + 1.25]]])
    return result


COLOURS = {
    "case": WOOD,
    "panel": CREAM,
    "foot": WOOD_DARK,
    "handle": WOOD_DARK,
    "aerial": CHROME,
    "ball": RED,
    "rim": BRASS,
    "white": (0.98, 0.97, 0.92),
    "iris": TEAL,
    "pupil": BLACK,
    "glint": (1, 1, 1),
    "lid": (0.80, 0.52, 0.30),
    "lash": BLACK,
    "brow": WOOD_DARK,
    "hollow": (0.16, 0.05, 0.05),
    "tongue": (0.80, 0.34, 0.33),
    "keys": (0.98, 0.96, 0.88),
    "lip": RED,
    "scale": (0.20, 0.32, 0.30),
    "needle": (0.95, 0.35, 0.2),
    "knob": BRASS,
}


def _pieces(p):
    """Return all pieces of the radio in its own axes, name -> (N, 3) [cm]."""
    result = _case(p)
    for side in ("r", "l"):
        result |= {f"{name}_{side}": piece for name, piece in _eye(p, side).items()}
    return result | _mouth(p) | _scale(p)


def _capped():
    """Return the faces of the pieces that are neither fans nor plain grids, name -> list."""
    tube, back = modelling.grid(4, CASE, closed=True), modelling.fan(CASE, 3 * CASE, 4 * CASE)
    ends = modelling.flipped(modelling.fan(BALL, 2 * BALL, 3 * BALL + 1))
    ball = modelling.flipped(modelling.grid(3, BALL, closed=True))
    knob = modelling.flipped(modelling.grid(2, KNOB, closed=True))
    return {
        "case": modelling.flipped(tube + back),
        "foot": [*modelling.grid(2, 4, closed=True), (3, 2, 1, 0)],
        "ball": ball + modelling.fan(BALL, 0, 3 * BALL) + ends,
        "knob": knob + modelling.fan(KNOB, KNOB),
        "rim": modelling.flipped(modelling.grid(3, ROUND, closed=True)),
    }


def _bar(half):
    """Return the faces of two ribbons of so many columns, one behind the other."""
    quads = modelling.grid(2, half)
    behind = [tuple(v + 2 * half for v in face) for face in modelling.flipped(quads)]
    sides = ((half, 3 * half), (2 * half, 0))
    edges = [(a + i, a + i + 1, b + i + 1, b + i) for a, b in sides for i in range(half - 1)]
    return quads + behind + edges


def _faces(name, count):
    """Return the faces of a piece."""
    kind = name.rsplit("_", 1)[0]
    if kind in ("panel", "white", "iris", "pupil", "glint"):
        return modelling.fan(count - 1)
    if kind in ("handle", "aerial"):
        return _bar(count // 4)
    rows = {"lidlow": 3, "lidup": 3, "lipup": 3, "liplow": 3, "brow": 4}.get(kind, 2)
    return _capped().get(kind) or modelling.grid(rows, count // rows)


def build(neutral):
    """Build the radio.

    Parameters
    ----------
    neutral : dict of the neutral's expression parameters
    """
    parts = modelling.Pieces()
    for name, vertices in _pieces(neutral).items():
        colour = next(c for key, c in COLOURS.items() if name.startswith(key))
        parts.add(name, len(vertices), _faces(name, len(vertices)), colour)
    pupils = parts.numbers("iris", "pupil", "glint", "needle")
    spans = np.split(pupils, np.flatnonzero(np.diff(pupils) > 1) + 1)
    listed = ",".join(f"{span[0]}-{span[-1]}" for span in spans)
    masks = [
        "region\taxis\tfrom\tto\tvertices",
        "mouth\t\t\t\t",
        "eyes\tz\t-0.022\t-0.008\t",
        f"pupils\t\t\t\t{listed}",
    ]

    def pose(p):
        points = np.concatenate(list(_pieces(p).values())) / 100
        return np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)

    row = {"unit": "m", "up_axis": "z", "pivot": "0 0.02 -0.10", "face_unit": "0.128"}
    return modelling.Character(
        "radio", pose, parts.faces, np.concatenate(parts.colours), masks, 5, row
    )
