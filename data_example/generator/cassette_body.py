"""Shape the cassette player's chassis, and what an emotion does to all of it."""

import numpy as np

from data_example.generator import fields, modelling

WIDE, HIGH, DEEP = 21.2, 10.5, 5.0
COLUMNS, ROWS = 9, 5
# what the chassis does in the neutral: bends and turns [rad], sizes and bulges as shares
REST = {
    "curve": 0.0, "swell": 0.0, "tall": 1.0, "wide": 1.0, "puff": 0.0, "lean": 0.0, "nod": 0.0,
    "turn": 0.0, "slump": 0.0, "hop": 0.0, "handle": 0.0, "aerial": 0.0, "droop": 0.0,
    "keys": 0.0, "taper": 0.0,
}  # fmt: skip
BODIES = {
    "serenity": "curve=0.14 wide=1.02 nod=-0.05 handle=-0.2 aerial=0.15 droop=0.2",
    "joy": "curve=0.5 tall=1.06 hop=1.2 handle=0.5 aerial=-0.2 swell=0.03",
    "ecstasy": "curve=0.72 tall=1.18 hop=2.4 handle=1 aerial=-0.5 swell=0.06 nod=-0.16 keys=0.8",
    "trust": "curve=0.2 nod=0.12 lean=0.1 handle=0.15 aerial=0.25 puff=0.1",
    "fear": "wide=0.86 tall=1.06 curve=-0.12 nod=-0.16 taper=-0.14 handle=-0.6 aerial=-0.45 "
    "keys=-0.6 turn=0.14",
    "surprise": "swell=0.06 hop=1.2 tall=1.2 wide=0.98 handle=1 aerial=-0.35 puff=0.1 keys=0.6",
    "amazement": "swell=0.27 hop=1 tall=1.08 handle=1.2 aerial=-0.5 puff=0.22 nod=-0.08 keys=1",
    "sadness": "curve=-0.42 slump=0.55 tall=0.95 nod=0.14 handle=-0.7 aerial=0.6 droop=1.1",
    "grief": "curve=-0.66 slump=1 tall=0.86 nod=0.14 lean=0.08 handle=-1 aerial=0.9 droop=1.9",
    "disgust": "lean=-0.18 turn=0.14 taper=0.16 curve=-0.14 nod=-0.1 aerial=0.5 puff=-0.1",
    "anger": "puff=0.3 lean=-0.1 nod=0.1 taper=0.14 curve=0.1 handle=-0.5 aerial=-0.3 tall=0.94",
    "rage": "puff=0.5 lean=-0.1 nod=0.12 taper=0.26 swell=0.1 curve=0.16 handle=-0.8 aerial=-0.6 "
    "keys=1",
    "anticipation": "lean=0.14 nod=0.16 curve=0.16 tall=1.07 handle=0.4 aerial=-0.25 turn=-0.14",
    "contempt": "lean=-0.15 nod=-0.1 turn=0.13 curve=0.1 handle=-0.3 aerial=0.4",
}
HANDLE_ENDS, AERIAL_FOOT = 12.5, np.array([16.5, 10.0])
BUTTONS = (-7.5, -2.5, 2.5, 7.5)


def _sheet(width, height, z):
    """Return the front or back as a grid with rounded corners, (ROWS, COLUMNS, 3)."""
    u, v = np.meshgrid(np.linspace(-1, 1, COLUMNS), np.linspace(-1, 1, ROWS))
    round_ = 1 - 0.05 * (np.abs(u * v) > 0.99)
    return np.stack([width * u * round_, height * v * round_, z + 0 * u], axis=-1)


def border():
    """Return the numbers of the panel's border, counter-clockwise, (N,) int."""
    index = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)
    sides = (index[0, :-1], index[:-1, -1], index[-1, :0:-1], index[:0:-1, 0])
    return np.concatenate(sides)


def chassis():
    """Return the panel and the rings of the box behind it, (N, 3), and the box's faces."""
    panel = _sheet(WIDE - 0.8, HIGH - 0.8, DEEP).reshape(-1, 3)
    edge = border()
    rings = [
        _sheet(w, h, z).reshape(-1, 3)[edge]
        for w, h, z in (
            (WIDE - 0.7, HIGH - 0.7, DEEP - 0.02),
            (WIDE, HIGH, DEEP - 1.0),
            (WIDE, HIGH, -DEEP + 1.0),
            (WIDE - 1.2, HIGH - 1.2, -DEEP),
        )
    ]
    count = len(edge)
    faces = modelling.flipped(modelling.grid(len(rings), count, closed=True))
    last = (len(rings) - 1) * count
    faces += [
        (last + i, last + count - 1 - i, last + count - 2 - i, last + i + 1)
        for i in range(count // 2 - 1)
    ]
    return panel, np.concatenate(rings), faces


def fittings(body):
    """Return handle, aerial and buttons, name -> (N, 3)."""
    angle = np.linspace(0, np.pi, 7)
    rise = 4.6 * (1 + 0.35 * body["handle"])
    arc = np.stack([-HANDLE_ENDS * np.cos(angle), 10.0 + rise * np.sin(angle) ** 0.45], axis=1)
    arc[1:-1, 0] *= 1.04
    bar = modelling.ribbon(arc[::-1], 1.2)
    result = {"handle": np.concatenate([modelling.raised(bar, z) for z in (-0.6, -2.4)])}
    at = np.linspace(0, 1, 4)
    lean = 0.35 + body["aerial"] + body["droop"] * at**1.5
    steps = 4.2 * np.stack([np.sin(lean), np.cos(lean)], axis=1)
    line = AERIAL_FOOT + np.concatenate([[[0, 0]], np.cumsum(steps[:-1], axis=0)])
    rod = modelling.ribbon(line, [0.6, 0.5, 0.4, 0.3])
    result["aerial"] = np.concatenate([modelling.raised(rod, z) for z in (-2.8, -3.3)])
    corners = np.array(
        [[a, b, c] for c in (1, -1) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    )
    result["ball"] = 0.62 * corners + np.append(line[-1], -3.05)
    for number, x in enumerate(BUTTONS):
        pressed = 0.55 * (1 if number % 2 else -1) * body["keys"]
        size = np.array([1.7, 1.0, 1.4])
        result[f"button{number}"] = corners * size + [x, 10.7 + pressed, 2.2]
    return result


def _turn(points, axis, angle):
    """Turn points about an axis, (N, 3)."""
    a, b = [k for k in range(3) if k != axis]
    c, s = np.cos(angle), np.sin(angle)
    result = points.copy()
    result[:, a] = c * points[:, a] - s * points[:, b]
    result[:, b] = s * points[:, a] + c * points[:, b]
    return result


def warp(points, body):
    """Bend, swell, slump and turn whatever stands on the chassis, (N, 3) [cm]."""
    result = points * [body["wide"], body["tall"], 1.0]
    result[:, 0] *= 1 + body["taper"] * points[:, 1] / HIGH
    inside = np.cos(0.5 * np.pi * np.clip(points[:, :2] / [1.25 * WIDE, 1.25 * HIGH], -1, 1))
    # the back bulges more than the front, on which eyes and mouth stand
    back = fields.smoothstep(DEEP, -DEEP, points[:, 2])
    result[:, 2] *= 1 + (0.3 + 1.2 * back) * body["puff"] * inside.prod(axis=1)
    result[:, 0] *= 1 + 0.22 * body["puff"] * inside[:, 1]
    result[:, 1] *= 1 + 0.30 * body["puff"] * inside[:, 0]
    # the top gives way in the middle, and what is below spreads
    up = fields.smoothstep(-HIGH, HIGH, points[:, 1])
    result[:, 1] -= 2.6 * body["slump"] * up * inside[:, 0]
    result[:, 0] *= 1 + 0.10 * body["slump"] * (1 - 2 * up)
    result *= 1 + body["swell"] * np.array([1.0, 1.0, 0.5])
    bend = body["curve"] / WIDE
    if bend:
        way = bend * result[:, 0]
        # what stands on the top goes straight up, lest the ends of the handle meet
        above = np.maximum(result[:, 1] - HIGH, 0)
        radius = 1 / bend - result[:, 1] + above
        result[:, 0], result[:, 1] = radius * np.sin(way), 1 / bend - radius * np.cos(way) + above
        result[:, 1] -= 0.22 * body["curve"] * WIDE
    for axis, word, sign in ((2, "lean", -1), (0, "nod", 1), (1, "turn", -1)):
        result = _turn(result, axis, sign * body[word])
    result[:, 1] += body["hop"]
    return result
