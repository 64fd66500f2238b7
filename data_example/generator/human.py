"""Model the human character: an old bald man with a big chin and bushy brows, in centimetres.

He is modelled in millimetres like the actor, from other solids with other proportions.
"""

import numpy as np

from data_example.generator import charts, features, fields, solids

CENTRE = np.array([0.0, -25.0, 0.0])
HINGE = np.array([0.0, -22.0, -4.0])
RINGS, LIDS = 24, 12
SPOKES = 8
MOUTH = np.array([0.0, -82.0, 90.0])
MOUTH_HALF = 31.0
GAINS = features.Gains(jaw=0.95, corner=0.38, lift=0.20, drop=0.22, out=0.22, up=0.26, narrow=0.45)
EYE = {"r": np.array([-27.0, 0.0, 58.0]), "l": np.array([27.0, 0.0, 58.0])}
BALL = 14.5
ANGLE = 2 * np.pi * np.arange(RINGS) / RINGS
ALONG = -np.cos(ANGLE)
LOWER = np.arange(RINGS) <= RINGS // 2
LID_ALONG = -np.cos(2 * np.pi * np.arange(LIDS) / LIDS)
LID_LOWER = np.arange(LIDS) <= LIDS // 2
BROW = np.array([[-47, 19.0], [-41, 25.5], [-32, 27.5], [-22, 25.5], [-12, 20.0]])


def head(points):
    """Return the signed distance to the skin [mm]."""
    p = np.array(points, float)
    p[..., 0] = np.abs(p[..., 0])
    d = solids.ellipsoid(p, (0, 30, -14), (68, 74, 84))
    d = solids.join(d, solids.ellipsoid(p, (0, -25, 10), (58, 72, 66)), 22)
    d = solids.join(d, solids.ellipsoid(p, (0, -122, 64), (31, 24, 30)), 22)
    d = solids.join(d, solids.capsule(p, (57, -48, -4), (24, -114, 48), 17, 17), 22)
    d = solids.join(d, solids.ellipsoid(p, (38, -44, 48), (22, 26, 24)), 20)
    d = solids.join(d, solids.capsule(p, (7, 18, 74), (44, 20, 56), 11, 10), 14)
    d = solids.cut(d, solids.ellipsoid(p, (27, -2, 95), (19, 12, 19)), 14)
    d = solids.join(d, solids.ellipsoid(p, (27, 0, 58), (15.6, 14.6, 15.4)), 7)
    d = solids.join(d, solids.ellipsoid(p, (0, -82, 54), (38, 26, 36)), 22)
    d = solids.join(d, solids.capsule(p, (0, 8, 74), (0, -36, 96), 8, 10), 12)
    d = solids.join(d, solids.ellipsoid(p, (0, -41, 100), (15, 13.5, 16)), 9)
    d = solids.join(d, solids.ellipsoid(p, (15, -45, 90), (9, 8.5, 11)), 7)
    d = solids.join(d, solids.capsule(p, (0, -70, -22), (0, -260, -34), 43, 52), 24)
    return np.maximum(d, -172 - p[..., 1])


def _jaw(points, p):
    """Return the displacement of what is fixed to the jaw [mm]."""
    angle, side = np.deg2rad(17.0) * p["jaw_open"], np.deg2rad(8.0) * p["jaw_side"]
    q = points - HINGE
    y = q[..., 1] * np.cos(angle) - q[..., 2] * np.sin(angle)
    z = q[..., 1] * np.sin(angle) + q[..., 2] * np.cos(angle)
    return np.stack([q[..., 0] + z * np.sin(side), y, z * np.cos(side)], axis=-1) - q


def _skin_field(points, p):
    """Return the displacement of the skin far from lips and lids [mm]."""
    weight = fields.smoothstep(-58, -100, points[:, 1])
    weight *= fields.smoothstep(-30, 36, points[:, 2] - 0.25 * np.abs(points[:, 0]))
    weight *= fields.smoothstep(-190, -140, points[:, 1] - 0.2 * points[:, 2])
    move = weight[:, None] * _jaw(points, p)
    for side, name in ((1, "l"), (-1, "r")):
        cheek = fields.bell(points, (side * 38, -44, 64), (19, 17, 45))
        move += p[f"smile_{name}"] * cheek[:, None] * [side * 4.5, 9.0, 7.0]
        wing = fields.bell(points, (side * 15, -45, 94), (10, 9, 16))
        move += wing[:, None] * [side * 2.0 * p[f"smile_{name}"], 4.0 * p["upper_up"], 0]
        bag = fields.bell(points, (side * 28, -20, 72), (18, 10, 40))
        move += p["squint"] * bag[:, None] * [0, 4.0, 2.0]
        brow = features.brow(p, name, np.clip((52 - side * points[:, 0]) / 40, 0, 1))
        near = fields.bell(points, (side * 29, 27, 66), (27, 19, 60))
        move[:, :2] += near[:, None] * 30 * brow
    return move


def _lips(p):
    """Return the mouth's rings from the throat to the lips' outer border, (5, RINGS, 3) [mm]."""
    upper, lower = features.lips(p, ALONG, GAINS)
    flat = np.where(LOWER[:, None], lower, upper) * MOUTH_HALF
    flat[:, 1] += 1.5 * ALONG**2
    push = 10.0 * features.forward(p) * (1 - 0.6 * ALONG**2)
    depth = MOUTH[2] - 0.0185 * flat[:, 0] ** 2 + push
    hang = np.where(LOWER, -flat[:, 1] / MOUTH_HALF, 0)
    inner = np.column_stack([flat + MOUTH[:2], depth - 9.0 * np.maximum(hang, 0)])
    sign = np.where(LOWER, -1.0, 1.0)
    end = np.maximum(1 - ALONG**4, 0) ** 0.6
    thick = np.where(LOWER, 7.5, 4.8) * end * features.fullness(p)
    outer = inner + np.column_stack([1.5 * ALONG**9, sign * thick, -0.02 * push])
    middle = inner + 0.45 * (outer - inner)
    middle[:, 2] += np.where(LOWER, 4.2, 2.6) * end * (1 - 0.7 * p["press"])
    behind = inner + np.column_stack([0 * end, sign * 2.0 * end, 0 * end - 7])
    bag = inner + np.column_stack([0 * end, sign * 11 * end, 0 * end - 22])
    throat = bag.mean(axis=0) + 0.02 * (bag - bag.mean(axis=0)) - [0, 0, 26]
    return np.stack([throat, behind, inner, middle, outer])


def _lids(side, p):
    """Return the lids' rings from the ball to the crease, (4, LIDS, 3) [mm]."""
    high, low = features.lid_heights(p, side, 0.38, -0.52, -0.28)
    s = LID_ALONG
    tilt = (-0.05 if side == "l" else 0.05) * s
    arch = np.maximum(1 - s * s, 0) ** 0.7
    edge = tilt + np.where(LID_LOWER, low, high) * arch * 0.95
    crease = tilt + np.where(LID_LOWER, -0.80, 0.85) * np.maximum(1 - s * s, 0) ** 0.6
    rows = []
    for t, radius in ((0, BALL + 1.2), (0, BALL + 2.6), (0.5, BALL + 3.2), (1, BALL + 1.8)):
        a, e = 0.98 * s * (1 + 0.15 * t), edge + t * (crease - edge)
        direction = np.stack([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)], axis=1)
        rows.append(EYE[side] + radius * direction)
    return np.stack(rows)


def _ball(side, p):
    """Return an eyeball: rings round the gaze, then its pole, (49, 3) [mm]."""
    angles = np.array([0.20, 0.23, 0.50, 0.54, 0.95, 1.45])
    around = 2 * np.pi * np.arange(SPOKES) / SPOKES
    a, r = np.meshgrid(angles, around, indexing="ij")
    ball = np.stack([np.sin(a) * np.cos(r), np.sin(a) * np.sin(r), np.cos(a)], -1).reshape(-1, 3)
    ball = np.vstack([ball, [0, 0, 1]]) * BALL
    yaw, pitch = 0.50 * p["gaze_x"], 0.36 * p["gaze_y"]
    y = ball[:, 1] * np.cos(pitch) + ball[:, 2] * np.sin(pitch)
    z = ball[:, 2] * np.cos(pitch) - ball[:, 1] * np.sin(pitch)
    x = ball[:, 0] * np.cos(yaw) + z * np.sin(yaw)
    return EYE[side] + np.stack([x, y, z * np.cos(yaw) - ball[:, 0] * np.sin(yaw)], axis=1)


def brow_rest(side):
    """Return a bushy brow at rest: three rows, the middle one in front, (18, 3) [mm]."""
    at = np.linspace(0, len(BROW) - 1, 6)
    line = np.stack([np.interp(at, np.arange(len(BROW)), c) for c in BROW.T], axis=1)
    line[:, 0] *= -1 if side == "l" else 1
    on = charts.in_front(head, line)
    height = np.array([2.4, 5.0, 6.2, 6.4, 5.8, 3.4])[:, None]
    ragged = np.array([0.2, 1.4, -0.6, 1.2, -0.4, 0.6])[:, None] * [0, 1.0, 0.4]
    low, top = on - height * [0, 0.55, 0], on + height * [0, 0.75, 0] + ragged
    return np.concatenate([low - [0, 0, 1.0], on + height * [0, 0, 0.9], top - [0, 0, 1.5]])


def teeth(upper):
    """Return a row of teeth at rest, two rows of nine, (18, 3) [mm]."""
    x = np.linspace(-24, 24, 9)
    z = 84 - 0.023 * x * x
    ends = (-72.0, -83.0 + 0.006 * x * x) if upper else (-97.0, -87.5)
    rows = [
        np.column_stack([x, end + 0 * x, z + d]) for end, d in zip(ends, (-1, 0.5), strict=True)
    ]
    return np.concatenate(rows if not upper else rows[::-1])


def _lattice(outlines):
    """Return places spread over the head, with a ring of them at the neck's end, (N, 2) [mm]."""
    turn = 2 * np.pi * np.arange(12) / 12
    rim = np.stack([50 * np.sin(turn), 0 * turn - 171.5, 50 * np.cos(turn) - 28], axis=1)
    neck = charts.to_chart(rim, CENTRE)
    spread = charts.lattice(outlines, (15.9, 36.0), 2.5 * charts.MM, 7.0, None)
    spread = spread[~charts.within(spread, neck, 15.0)]
    middle = charts.to_chart(np.array([[0.0, -172.0, -28.0]]), CENTRE)
    return np.concatenate([spread, neck, middle])


class Rest:
    """The man's fixed geometry: skin rings and lattice with what they follow."""

    def __init__(self, neutral):
        lips = _lips(neutral)
        oval = charts.in_front(head, charts.oval(RINGS, (0, -83.0), 46, 22, 19))
        groups = [np.concatenate([lips, charts.patch(head, lips[-1], oval, (0.5, 1.0))])]
        for side in ("r", "l"):
            lids = _lids(side, neutral)
            oval = charts.in_front(head, charts.oval(LIDS, EYE[side][:2], 20, 15.5, 15))
            groups.append(np.concatenate([lids, charts.patch(head, lids[-1], oval, (0.5, 1.0))]))
        outlines = [charts.to_chart(group[-1], CENTRE) for group in groups]
        lattice = _lattice(outlines)
        places = [
            charts.ring_places(o, len(g), 0.08).reshape(-1, 2)
            for o, g in zip(outlines, groups, strict=True)
        ]
        self.rings, start = [], 0
        for group in groups:
            count = group.shape[0] * group.shape[1]
            self.rings.append(start + np.arange(count).reshape(group.shape[:2]))
            start += count
        on_skin = charts.around(head, CENTRE, lattice)
        self.skin = np.concatenate([*(g.reshape(-1, 3) for g in groups), on_skin])
        self.faces = charts.mesh(self.rings, np.concatenate([*places, lattice]))
        self.outer = lips[-1]
        self.nearest, distance = charts.follow(self.skin, self.outer)
        self.near = np.exp(-((distance / 19.0) ** 2)) * fields.smoothstep(20, 50, self.skin[:, 2])
        self.near *= fields.smoothstep(-44, -60, self.skin[:, 1])
        self.creases = {side: _lids(side, neutral)[-1] for side in ("r", "l")}
        self.brows = {side: brow_rest(side) for side in ("r", "l")}


def pose_skin(rest, p):
    """Return the skin's vertices, (V, 3) [mm]."""
    lips = _lips(p)
    extra = lips[-1] - rest.outer - _skin_field(rest.outer, p)
    pulled = charts.at_ring(extra, rest.nearest)
    result = rest.skin + _skin_field(rest.skin, p) + rest.near[:, None] * pulled
    result[rest.rings[0][: len(lips)]] = lips
    for side, rings in zip(("r", "l"), rest.rings[1:], strict=True):
        lids = _lids(side, p)
        result[rings[: len(lids)]] = lids
        between = rings[len(lids)]
        field = result[between] - rest.skin[between]
        result[between] = rest.skin[between] + (field + lids[-1] - rest.creases[side]) / 2
    return result


def pose(rest, p):
    """Return all pieces of the man, name -> (N, 3) [mm]."""
    result = {"skin": pose_skin(rest, p)}
    for side in ("r", "l"):
        result[f"ball_{side}"] = _ball(side, p)
        brow = rest.brows[side]
        result[f"brow_{side}"] = brow + _skin_field(brow, p)
    result["upper"] = teeth(upper=True)
    result["lower"] = teeth(upper=False) + _jaw(teeth(upper=False), p)
    return result
