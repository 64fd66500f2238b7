"""Model what moves on the cassette player: two speakers as eyes, the compartment as a mouth.

In centimetres, x to its left, y up, z forwards; heights over the front panel are added to FRONT.
"""

import numpy as np

from data_example.generator import features, modelling

FRONT = 5.0
GAINS = features.Gains(jaw=0.86, corner=0.08, lift=0.16, drop=0.2, out=0.14, up=0.3, narrow=0.5)
EYE = {"r": np.array([-13.4, 0.6]), "l": np.array([13.4, 0.6])}
CONE, ROUND = 5.3, 14
MOUTH = np.array([0.0, -2.0])
MOUTH_HALF, BASE = 5.7, (6.8, 5.4)
RING = 20
# height at which door and case meet
MEET = 1.6
LID = np.linspace(-0.999, 0.999, 9)
KEYS = 8


def ring_line():
    """Return the places of the compartment's ring from corner to corner, and which are below."""
    return -np.cos(2 * np.pi * np.arange(RING) / RING), np.arange(RING) <= RING // 2


def _frame(width, height, p, share):
    """Return the compartment's case, which stretches with its door, (RING, 2)."""
    s, below = ring_line()
    box = np.sign(s) * np.minimum(1.25 * np.abs(s), 1.0)
    tall = np.minimum(2.0 * np.sqrt(np.maximum(1 - s * s, 0)), 1.0)
    flat = np.stack([width * box, np.where(below, -height, height) * tall], axis=1)
    flat[:, 0] *= 1 + share * (0.16 * p["stretch"] - 0.2 * p["pucker"] - 0.06 * p["funnel"])
    flat[:, 0] += share * 1.2 * p["jaw_side"] * below
    flat[:, 1] -= np.where(below, share * 2.4 * p["jaw_open"] * tall, 0)
    smile = np.where(s > 0, p["smile_l"], p["smile_r"]) - 0.8 * p["frown"]
    flat[:, 1] += share * 1.5 * smile * s * s
    return flat


def mouth(p):
    """Return the compartment: case, lips and well; door, keys, tape, name -> (N, 3)."""
    p = dict(p)
    for side in ("smile_l", "smile_r"):
        p[side] = p[side] - 0.5 * p["frown"]
    s, below = ring_line()
    upper, lower = features.lips(p, s, GAINS)
    flat = np.where(below[:, None], lower, upper) * MOUTH_HALF + [0, MEET]
    gap = (upper - lower)[:, 1] * MOUTH_HALF
    end = np.maximum(1 - s**4, 0) ** 0.5
    push = 3.0 * features.forward(p)
    full = features.fullness(p) * (0.3 + 0.7 * end)
    lip = flat + np.stack([0.5 * np.sign(s) * s**8, np.where(below, -1.3, 0.9) * full], axis=1)
    tip = np.where(below, 0.28 * np.maximum(gap, 0), 0)
    well = _frame(5.6, 3.9, p, 0.9)
    rows = (
        (_frame(*BASE, p, 0.55), 0.0 * s),
        (_frame(BASE[0] - 0.7, BASE[1] - 0.7, p, 0.9), 1.3 + 0.7 * push + 0.6 * tip),
        (lip, 2.1 + push + tip),
        (flat, 1.6 + push + tip),
        (well, 0.35 + 0.0 * s),
    )
    case = [modelling.raised(MOUTH + ring, FRONT + z) for ring, z in rows]
    result = {"mouth": np.concatenate(case)}
    places = np.linspace(-0.7, 0.7, KEYS)
    high, low = (MOUTH_HALF * line for line in features.lips(p, places, GAINS))
    gap = (high - low)[:, 1]
    shown = max(1 - 0.85 * p["pucker"] - 0.6 * p["funnel"], 0.1)
    bite = high - np.stack([0 * gap, shown * np.minimum(0.4 * gap, 1.1)], axis=1)
    teeth = [MOUTH + line + [0, MEET] for line in (bite, high)]
    result["keys"] = modelling.raised(np.concatenate(teeth), FRONT + 1.45 + push)
    return result | _tape(p, push) | _reels(case[1], case[2])


def _tape(p, push):
    """Return the cassette in the well and its tape, which is the tongue, name -> (N, 3)."""
    drop = 1.7 * p["jaw_open"]
    slab = np.array([[-4.4, -3.2], [0, -3.2], [4.4, -3.2], [-4.4, 2.0], [0, 2.0], [4.4, 2.0]])
    slab[:, 0] *= 1 - 0.25 * p["pucker"]
    slab[:, 1] -= drop
    result = {"slab": modelling.raised(MOUTH + slab, FRONT + 0.55)}
    for side, x in (("r", -2.1), ("l", 2.1)):
        hub = modelling.circle(8, 0.95)
        hub += MOUTH + np.array([x * (1 - 0.25 * p["pucker"]), 0.2 - 0.5 * drop])
        result[f"hub_{side}"] = modelling.raised(hub, FRONT + 0.75)
    places = np.array([-0.45, 0.0, 0.45])
    high, low = (MOUTH_HALF * line for line in features.lips(p, places, GAINS))
    gap = (high - low)[:, 1]
    rows = []
    for share, lift, z, out in ((0.0, 0.1, 0.7, 0), (0.16, 0.5, 1.1, 0.8), (0.02, 0.3, 1.5, 2)):
        rise = gap * (share + lift * p["tongue_up"]) * np.array([0.5, 1.0, 0.5])
        line = MOUTH + low + np.stack([0 * rise, rise + MEET], axis=1)
        height = z + 0.8 * push + out * p["tongue_up"]
        rows.append(modelling.raised(line, FRONT + height))
    result["tape"] = np.concatenate(rows)
    return result


def _reels(outer, lip):
    """Return the two reels on the door, which go where it goes, name -> (16, 3)."""
    result = {}
    third = RING // 4
    for side, i in (("r", third - 2), ("l", third + 2)):
        a, b = lip[i], outer[i]
        centre, down = a + 0.52 * (b - a), b - a
        down = down / np.linalg.norm(down)
        out = np.cross([1.0, 0, 0], -down)
        rings = []
        for radius, height in ((1.15, 0.12), (0.5, 0.35)):
            flat = modelling.circle(8, radius)
            rings.append(centre + flat[:, :1] * [1.0, 0, 0] - flat[:, 1:] * down + height * out)
        result[f"reel_{side}"] = np.concatenate(rings)
    return result


def eye(p, side):
    """Return a speaker: rim, cone with its cap, shutters and brow, name -> (N, 3)."""
    centre = EYE[side]
    big = CONE * (1 + 0.07 * p["wide"])
    rim = [(big + 1.0, -0.1), (big + 0.45, 1.35), (big - 0.15, 0.9)]
    rims = [modelling.raised(modelling.circle(ROUND, r) + centre, FRONT + z) for r, z in rim]
    look = np.array([1.5 * p["gaze_x"], 1.3 * p["gaze_y"]])
    cap = 2.2 * (1 + 0.45 * p["pupil"])
    pump = 0.5 * p["wide"]
    cone = (
        (big, 0.75, 0.0),
        (3.5, 0.35, 0.5),
        (cap, 0.3, 1.0),
        (cap, 0.34, 1.0),
        (0.6 * cap, 0.95, 1.0),
    )
    rows = [
        modelling.raised(
            modelling.circle(ROUND, r) + centre + share * look, FRONT + z + pump * share
        )
        for r, z, share in cone
    ]
    spot = modelling.circle(4, 0.5) + centre + look + [-0.75, 0.8]
    result = {
        "rim": np.concatenate(rims),
        "cone": np.concatenate(rows),
        "glint": modelling.raised(spot, FRONT + 1.05 + pump),
    }
    return result | _shutters(p, side, big) | {"brow": _brow(p, side)}


def _shutters(p, side, big):
    """Return both shutters of a speaker, rows from below, name -> (27, 3)."""
    inner = 1.0 if side == "r" else -1.0
    high = features.lid_heights(p, side, 0.74, -0.86, -0.18)[0]
    # the lower one comes late
    late = p | {f"blink_{side}": p[f"blink_{side}"] ** 2}
    low = features.lid_heights(late, side, 0.74, -0.86, -0.18)[1]
    awake = 1 - p[f"blink_{side}"]
    tilt = 0.34 * p[f"brow_inner_{side}"] - 0.7 * p["brow_frown"]
    slant = awake * inner * tilt * LID
    top = high + slant - awake * 0.2 * p["brow_frown"] + awake * 0.06 * p["gaze_y"]
    below = low + 0.25 * slant
    top = np.clip(top, below, 1.0)
    arc = big * np.sqrt(1 - LID * LID)
    x = EYE[side][0] + big * LID
    result = {}
    for name, edge, end in (("up", top, 1.0), ("low", np.maximum(below, -1.0), -1.0)):
        rows = []
        for share, z in ((0.0, 1.75), (0.5, 1.6), (1.0, 1.0)):
            y = EYE[side][1] + (edge + share * (end - edge)) * arc
            dome = z + 0.25 * np.sqrt(1 - LID * LID)
            rows.append(modelling.raised(np.stack([x, y], 1), FRONT + dome))
        result[f"lid{name}"] = np.concatenate(rows if name == "up" else rows[::-1])
    return result


def _brow(p, side):
    """Return the bar over a speaker, four rows of six, (24, 3)."""
    t = np.linspace(0, 1, 6)
    out = 1 if side == "l" else -1
    line = EYE[side] + np.stack(
        [out * (4.2 - 8.2 * t), 6.9 + 0.9 * np.sin(np.pi * (0.1 + 0.75 * t))], axis=1
    )
    line += 6.0 * features.brow(p, side, t)
    outer, inner = (
        modelling.raised(modelling.ribbon(line, w), FRONT + z) for w, z in ((1.5, 0.0), (0.8, 1.3))
    )
    return np.concatenate([outer[:6], inner[:6], inner[6:], outer[6:]])
