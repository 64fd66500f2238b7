"""Model the clay head: big eyes far apart, a wide low mouth, hardly a nose, in centimetres.

It is modelled in millimetres like the actresses. Its shapes are ARKit's; each moves few vertices.
"""

import numpy as np

from data_example.generator import charts, features, fields, params, solids

CENTRE = np.array([0.0, -8.0, 0.0])
HINGE = np.array([0.0, -16.0, 6.0])
RINGS, LIDS = 24, 16
# number of the ring that is the lips' inner edge
INNER = 2
SPOKES = 9
MOUTH = np.array([0.0, -60.0, 84.0])
MOUTH_HALF = 38.0
MOUTH_CURVE = 0.0105
GAINS = features.Gains(jaw=0.88, corner=0.30, lift=0.22, drop=0.22, out=0.20, up=0.40, narrow=0.50)
EYE = {"r": np.array([-35.0, 6.0, 52.0]), "l": np.array([35.0, 6.0, 52.0])}
BALL = 25.0
ALONG = -np.cos(2 * np.pi * np.arange(RINGS) / RINGS)
LOWER = np.arange(RINGS) <= RINGS // 2
LID_ALONG = -np.cos(2 * np.pi * np.arange(LIDS) / LIDS)
LID_LOWER = np.arange(LIDS) <= LIDS // 2
BALL_ANGLES = np.array([0.18, 0.21, 0.43, 0.47, 1.40])
BROW = np.array([[-58, 40.0], [-48, 46.5], [-36, 48.5], [-24, 46.0], [-15, 41.5]])


def head(points):
    """Return the signed distance to the skin [mm]."""
    p = np.array(points, float)
    p[..., 0] = np.abs(p[..., 0])
    d = solids.ellipsoid(p, (0, 30, -8), (86, 82, 82))
    d = solids.join(d, solids.ellipsoid(p, (0, -34, 18), (76, 56, 66)), 34)
    d = solids.join(d, solids.ellipsoid(p, (48, -42, 40), (28, 26, 30)), 26)
    d = solids.join(d, solids.ellipsoid(p, (0, -88, 50), (24, 16, 24)), 22)
    d = solids.cut(d, solids.ellipsoid(p, (36, 8, 104), (26, 22, 24)), 18)
    d = solids.join(d, solids.ellipsoid(p, (35, 6, 52), (27, 25.5, 26)), 9)
    d = solids.join(d, solids.ellipsoid(p, (0, -62, 54), (44, 26, 32)), 20)
    d = solids.join(d, solids.ellipsoid(p, (0, -21, 91), (14, 12.5, 14)), 8)
    d = solids.join(d, solids.capsule(p, (0, -70, -14), (0, -190, -18), 34, 40), 26)
    return np.maximum(d, -142 - p[..., 1])


def jaw(points, open_, side):
    """Return the displacement of what is fixed to the jaw [mm]."""
    angle, turn = np.deg2rad(17.0) * open_, np.deg2rad(8.0) * side
    q = points - HINGE
    y = q[..., 1] * np.cos(angle) - q[..., 2] * np.sin(angle)
    z = q[..., 1] * np.sin(angle) + q[..., 2] * np.cos(angle)
    return np.stack([q[..., 0] + z * np.sin(turn), y, z * np.cos(turn)], axis=-1) - q


def lips(p, roll_upper=0.0, roll_lower=0.0):
    """Return the mouth's rings from the throat to the lips' outer border, (5, RINGS, 3) [mm]."""
    upper, lower = features.lips(p, ALONG, GAINS)
    flat = np.where(LOWER[:, None], lower, upper) * MOUTH_HALF
    flat[:, 1] += 3.0 * ALONG**2
    push = 13.0 * features.forward(p) * (1 - 0.6 * ALONG**2)
    depth = MOUTH[2] - MOUTH_CURVE * flat[:, 0] ** 2 + push
    # the lower lip goes back as it drops, and lies against the upper one when they meet
    hang = np.where(LOWER, upper[:, 1] - lower[:, 1], 0)
    inner = np.column_stack([flat + MOUTH[:2], depth - 9.0 * np.maximum(hang, 0)])
    sign = np.where(LOWER, -1.0, 1.0)
    end = np.maximum(1 - ALONG**4, 0) ** 0.6
    rolled = np.where(LOWER, roll_lower, roll_upper)
    thick = np.where(LOWER, 8.5, 6.5) * end * features.fullness(p) * (1 - 0.7 * rolled)
    outer = inner + np.column_stack([2.2 * ALONG**9, sign * thick, -0.02 * push])
    middle = inner + 0.5 * (outer - inner)
    middle[:, 2] += np.where(LOWER, 5.0, 4.0) * end * (1 - 0.7 * p["press"] - 0.9 * rolled)
    zero = 0 * end
    behind = inner + np.column_stack([2.0 * ALONG, sign * 17.0 * end, zero - 17])
    throat = inner.mean(axis=0) + 0.02 * (behind - inner.mean(axis=0)) - [0, 0, 58]
    return np.stack([throat, behind, inner, middle, outer])


def lids(side, p):
    """Return the lids' rings from the ball to the crease, (4, LIDS, 3) [mm]."""
    high, low = features.lid_heights(p, side, 0.50, -0.52, -0.26)
    follow = 0.10 * p["gaze_y"]
    s = LID_ALONG
    out = 1.0 if side == "l" else -1.0
    arch = np.maximum(1 - s * s, 0) ** 0.62
    open_ = 1 - p[f"blink_{side}"]
    edge = np.where(LID_LOWER, low + 0.5 * follow * open_, high + follow * open_) * arch
    edge = 0.04 * out * s + edge
    crease = 0.04 * out * s + np.where(LID_LOWER, -0.78, 0.86) * np.maximum(1 - s * s, 0) ** 0.55
    rows = []
    for t, radius in ((0, BALL + 0.8), (0, BALL + 3.0), (0.5, BALL + 3.6), (1, BALL + 1.6)):
        a, e = 0.92 * s * (1 + 0.15 * t), edge + t * (crease - edge)
        direction = np.stack([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)], axis=1)
        rows.append(EYE[side] + radius * direction)
    return np.stack(rows)


def ball(side, p):
    """Return an eyeball: rings round the gaze, then its pole, (5 * SPOKES + 1, 3) [mm]."""
    around = 2 * np.pi * np.arange(SPOKES) / SPOKES
    a, r = np.meshgrid(BALL_ANGLES, around, indexing="ij")
    points = np.stack([np.sin(a) * np.cos(r), np.sin(a) * np.sin(r), np.cos(a)], -1).reshape(-1, 3)
    points = np.vstack([points, [0, 0, 1]]) * BALL
    yaw, pitch = 0.46 * p["gaze_x"], 0.34 * p["gaze_y"]
    y = points[:, 1] * np.cos(pitch) + points[:, 2] * np.sin(pitch)
    z = points[:, 2] * np.cos(pitch) - points[:, 1] * np.sin(pitch)
    x = points[:, 0] * np.cos(yaw) + z * np.sin(yaw)
    return EYE[side] + np.stack([x, y, z * np.cos(yaw) - points[:, 0] * np.sin(yaw)], axis=1)


def brow_rest(side):
    """Return a brow, a roll of clay, at rest: three rows, (24, 3) [mm]."""
    at = np.linspace(0, len(BROW) - 1, 8)
    line = np.stack([np.interp(at, np.arange(len(BROW)), c) for c in BROW.T], axis=1)
    line[:, 0] *= -1 if side == "l" else 1
    on = charts.in_front(head, line)
    height = np.array([1.5, 4.5, 6.0, 6.6, 6.8, 6.4, 5.2, 1.8])[:, None]
    low, top = on - height * [0, 0.8, 0.3], on + height * [0, 0.8, -0.3]
    return np.concatenate([low, on + height * [0, 0.1, 1.0], top])


def teeth(upper):
    """Return a row of teeth at rest, two rows of nine, (18, 3) [mm]."""
    x = np.linspace(-27, 27, 9)
    z = 78 - 0.0165 * x * x
    ends = (-46.0, -59.5 + 0.009 * x * x) if upper else (-78.0, -67.0 + 0.006 * x * x)
    rows = [
        np.column_stack([x, end + 0 * x, z + d]) for end, d in zip(ends, (-1, 0.5), strict=True)
    ]
    return np.concatenate(rows if not upper else rows[::-1])


def tongue():
    """Return the tongue at rest, three rows of five, (15, 3) [mm]."""
    x = np.linspace(-17, 17, 5)
    hump = 1 - (x / 22) ** 2
    rows = [(-70.0, 44.0, 8.0), (-70.0, 62.0, 6.5), (-75.0, 72.0, 3.0)]
    return np.concatenate([np.column_stack([x, y + h * hump, z + 0 * x]) for y, z, h in rows])


def skin_field(points, p):
    """Return the displacement of the skin far from lips and lids [mm]."""
    weight = fields.smoothstep(-40, -82, points[:, 1])
    weight *= fields.smoothstep(-24, 34, points[:, 2] - 0.25 * np.abs(points[:, 0]))
    weight *= fields.smoothstep(-136, -104, points[:, 1] - 0.2 * points[:, 2])
    move = weight[:, None] * jaw(points, p["jaw_open"], p["jaw_side"])
    for side, name in ((1, "l"), (-1, "r")):
        cheek = fields.bell(points, (side * 50, -28, 66), (22, 18, 45))
        move += p[f"smile_{name}"] * cheek[:, None] * [side * 3.5, 9.0, 7.0]
        wing = fields.bell(points, (side * 12, -20, 92), (9, 9, 18))
        move += wing[:, None] * [side * 1.5 * p[f"smile_{name}"], 1.5 * p["upper_up"], 0]
        bag = fields.bell(points, (side * 36, -18, 72), (22, 9, 40))
        move += p["squint"] * bag[:, None] * [0, 4.5, 2.5]
        brow = features.brow(p, name, np.clip((62 - side * points[:, 0]) / 46, 0, 1))
        near = fields.bell(points, (side * 36, 46, 62), (32, 17, 60))
        move[:, :2] += near[:, None] * 52 * brow
    return move


class Rest:
    """The fixed geometry: skin rings and lattice with what they follow."""

    def __init__(self):
        zero = params.neutral()
        mouth = lips(zero)
        oval = charts.in_front(head, charts.oval(RINGS, (0, -59.0), 54, 27, 20))
        groups = [np.concatenate([mouth, charts.patch(head, mouth[-1], oval, (0.5, 1.0))])]
        for side in ("r", "l"):
            rings = lids(side, zero)
            oval = charts.in_front(head, charts.oval(LIDS, EYE[side][:2], 29, 25, 26))
            groups.append(np.concatenate([rings, charts.patch(head, rings[-1], oval, (0.5, 1.0))]))
        outlines = [charts.to_chart(group[-1], CENTRE) for group in groups]
        spread = self._lattice(outlines)
        places = [
            charts.ring_places(o, len(g), 0.08).reshape(-1, 2)
            for o, g in zip(outlines, groups, strict=True)
        ]
        self.rings, start = [], 0
        for group in groups:
            count = group.shape[0] * group.shape[1]
            self.rings.append(start + np.arange(count).reshape(group.shape[:2]))
            start += count
        on_skin = charts.around(head, CENTRE, spread)
        self.skin = np.concatenate([*(g.reshape(-1, 3) for g in groups), on_skin])
        self.faces = charts.mesh(self.rings, np.concatenate([*places, spread]))
        self.outer = mouth[-1]
        self.nearest, distance = charts.follow(self.skin, self.outer)
        self.near = np.exp(-((distance / 20.0) ** 2)) * fields.smoothstep(20, 50, self.skin[:, 2])
        self.near *= fields.smoothstep(-26, -42, self.skin[:, 1])
        self.creases = {side: lids(side, zero)[-1] for side in ("r", "l")}
        self.brows = {side: brow_rest(side) for side in ("r", "l")}

    @staticmethod
    def _lattice(outlines):
        """Return places spread over the head, with a ring of them at the neck's end, [mm]."""
        turn = 2 * np.pi * np.arange(12) / 12
        rim = np.stack([40 * np.sin(turn), 0 * turn - 141.5, 40 * np.cos(turn) - 16], axis=1)
        neck = charts.to_chart(rim, CENTRE)
        spread = charts.lattice(outlines, (14.0, 58.0), 2.55 * charts.MM, 8.0, None, even=True)
        spread = spread[~charts.within(spread, neck, 14.0)]
        middle = charts.to_chart(np.array([[0.0, -142.0, -16.0]]), CENTRE)
        return np.concatenate([spread, neck, middle])


def pose_skin(rest, p, **rolls):
    """Return the skin's vertices, (V, 3) [mm]."""
    mouth = lips(p, **rolls)
    extra = mouth[-1] - rest.outer - skin_field(rest.outer, p)
    pulled = charts.at_ring(extra, rest.nearest)
    result = rest.skin + skin_field(rest.skin, p) + rest.near[:, None] * pulled
    result[rest.rings[0][: len(mouth)]] = mouth
    for side, rings in zip(("r", "l"), rest.rings[1:], strict=True):
        shut = lids(side, p)
        result[rings[: len(shut)]] = shut
        between = rings[len(shut)]
        field = result[between] - rest.skin[between]
        result[between] = rest.skin[between] + (field + shut[-1] - rest.creases[side]) / 2
    return result


def pose(rest, p, **rolls):
    """Return all pieces that move, name -> (N, 3) [mm]."""
    result = {"skin": pose_skin(rest, p, **rolls)}
    for side in ("r", "l"):
        result[f"ball_{side}"] = ball(side, p)
        brow = rest.brows[side]
        result[f"brow_{side}"] = brow + skin_field(brow, p)
    result["upper"] = teeth(upper=True)
    for name, piece in (("lower", teeth(upper=False)), ("tongue", tongue())):
        result[name] = piece + jaw(piece, p["jaw_open"], p["jaw_side"])
    return result
