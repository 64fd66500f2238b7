"""Model the mouths and eyes of the planet, each in its own axes and with its own manners.

Flat places are angles about a feature's middle; heights are in radii of the planet.
"""

import numpy as np

from data_example.generator import features, globe_grid, modelling

SITES = globe_grid.SITES
MOUTHS = tuple(name for name in SITES if name.startswith("mouth"))
EYES = tuple(name for name in SITES if name.startswith("eye"))
GAINS = {
    "mouth_grand": features.Gains(jaw=0.72, corner=0.24, out=0.2, up=0.42, narrow=0.5),
    "mouth_askew": features.Gains(jaw=0.8, corner=0.3, out=0.22, up=0.5, narrow=0.45),
    "mouth_sleepy": features.Gains(jaw=0.62, corner=0.3, out=0.16, up=0.34, narrow=0.42),
    "mouth_prim": features.Gains(jaw=0.9, corner=0.3, out=0.2, up=0.4, narrow=0.4),
}
# share of a site that the lips take, and the thickness of lips in half widths
LIPS = 0.74
THICK = {"mouth_grand": 0.25, "mouth_askew": 0.24, "mouth_sleepy": 0.2, "mouth_prim": 0.3}
TEETH = 6
# of each row of the tongue: half its width, its height as a share of the gap, at rest and lifted,
# how far ahead it lies, and how far it comes out
ROWS = (
    (0.62, 0.0, 0.05, -0.16, 0.0),
    (0.52, 0.3, 0.4, -0.05, 0.15),
    (0.34, 0.02, 0.3, 0.0, 0.45),
)
BALL_SHARE = 0.94
BALL_RINGS = np.array([0.27, 0.31, 0.60, 0.66, 1.25, 1.95])
SPOKES = {"eye_moon": 12} | dict.fromkeys(("eye_middle", "eye_north", "eye_east", "eye_south"), 8)
GLINT = np.array([[0.12, 0.26], [0.26, 0.26], [0.26, 0.42], [0.12, 0.42]])


def manner(name, p):
    """Return the face as one of the mouths takes it."""
    q = dict(p)
    for side in ("smile_l", "smile_r"):
        q[side] = p[side] - 0.45 * p["frown"]
    p, closed = q.copy(), p["lip_close"]
    if name == "mouth_grand":
        q |= {key: 1.2 * p[key] for key in ("jaw_open", "stretch", "frown", "upper_up")}
    elif name == "mouth_askew":
        moved = 0.6 * p["jaw_open"] + 0.4 * p["frown"] + 0.3 * p["pucker"]
        q |= {"smile_l": 0.25 * p["smile_l"], "smile_r": 0.14 + 1.2 * p["smile_r"]}
        q["jaw_side"] = p["jaw_side"] - moved * (1 - closed)
    elif name == "mouth_sleepy":
        # it yawns rather than smiles
        q |= {key: 0.4 * p[key] for key in ("stretch", "smile_l", "smile_r")}
        q["frown"] = 0.22 + 0.7 * p["frown"]
        q["jaw_open"] = 0.12 + 1.15 * p["jaw_open"] + 0.1 * (p["smile_l"] + p["smile_r"])
    else:
        spread = p["stretch"] + p["smile_l"] + p["smile_r"]
        q |= {key: 0.55 * p[key] for key in ("stretch", "smile_l", "smile_r")}
        q["pucker"] = max(0.3 + 0.75 * p["pucker"] - 0.1 * spread, 0)
    return q


def along(count):
    """Return the places of a ring's vertices from corner to corner, and which are below."""
    return -np.cos(2 * np.pi * np.arange(count) / count), np.arange(count) <= count // 2


def mouth(name, p):
    """Return a mouth's rings from the outer border of the lips to the throat, teeth and tongue.

    Returns
    -------
    rings : (4, N, 3) float array, flat places [rad] and height
    teeth : (2 TEETH, 3) float array, lower edge first
    tongue : (9, 3) float array, rows from the root
    """
    site, q = SITES[name], manner(name, p)
    s, below = along(len(globe_grid.ring(site)))
    half = LIPS * np.deg2rad(site.half[0])
    upper, lower = features.lips(q, s, GAINS[name])
    flat = np.where(below[:, None], lower, upper)
    end = np.maximum(1 - s**4, 0) ** 0.5
    sign = np.where(below, -1.0, 1.0)
    thick = THICK[name] * features.fullness(q) * (0.25 + 0.75 * end)
    push = 0.34 * features.forward(q) * (1 - 0.5 * s * s)
    outer = flat + np.stack([0.09 * np.sign(s) * s**8, sign * thick], axis=1)
    middle = (flat + outer) / 2
    centre = flat.mean(axis=0)
    hole = np.maximum(0.12, upper[:, 1] - lower[:, 1])
    throat = centre + np.stack([0.7 * s, sign * 0.4 * hole * end], axis=1)
    rows = ((outer, 0.1 + 0.6 * push), (middle, 0.25 * end + 0.12 + push), (flat, 0.1 + push))
    rings = [modelling.raised(half * ring, half * z) for ring, z in (*rows, (throat, -0.55))]
    places = np.linspace(-0.72, 0.72, TEETH)
    upper, lower = features.lips(q, places, GAINS[name])
    gap = upper[:, 1] - lower[:, 1]
    forward = half * 0.34 * features.forward(q)
    shown = max(1 - 0.8 * q["pucker"] - 0.6 * q["funnel"], 0.1)
    bite = upper - np.stack([0 * gap, shown * np.minimum(0.42 * gap, 0.3)], axis=1)
    teeth = [modelling.raised(half * row, forward + 0.08 * half) for row in (bite, upper)]
    return np.stack(rings), np.concatenate(teeth), _tongue(name, q, half, forward)


def _tongue(name, q, half, forward):
    """Return the tongue, three by three, (9, 3)."""
    rows = []
    for wide, share, height, ahead, out in ROWS:
        upper, lower = features.lips(q, np.array([-wide, 0.0, wide]), GAINS[name])
        gap = (upper - lower)[:, 1]
        lift = (share + height * q["tongue_up"]) * np.array([0.45, 1.0, 0.45])
        line = lower + np.stack([0 * gap, gap * lift], axis=1)
        z = forward + ahead + out * half * q["tongue_up"]
        rows.append(modelling.raised(half * line, z))
    return np.concatenate(rows)


def _side(name):
    """Return the side of an eye, l or r, and the way to its inner end along it."""
    return ("r", 1.0) if SITES[name].at[0] < 0 else ("l", -1.0)


def _ball_radius(name):
    """Return the radius of an eyeball."""
    return BALL_SHARE * np.deg2rad(min(SITES[name].half))


def lids(name, p):
    """Return the lids' rings from the crease to the edge, in the ball's axes, (3, N, 3)."""
    side, inner = _side(name)
    s, below = along(len(globe_grid.ring(SITES[name])))
    high, low = features.lid_heights(p, side, 0.62, -0.66, -0.22)
    awake = 1 - p[f"blink_{side}"]
    arch = np.maximum(1 - s * s, 0) ** 0.6
    tilt = 0.42 * p[f"brow_inner_{side}"] - 0.55 * p["brow_frown"]
    slant = awake * inner * tilt * s * np.where(below, 0.3, 1.0)
    heavy = awake * (0.1 * p[f"brow_inner_{side}"] - 0.24 * p["brow_frown"])
    edge = np.where(below, low, high) * arch + slant * arch
    edge = edge + np.where(below, 0.0, heavy) * arch + 0.1 * awake * p["gaze_y"] * arch
    middle = low * arch
    edge = np.where(below, edge, np.maximum(edge, middle + slant))
    raise_ = 0.16 * p[f"brow_inner_{side}"] + 0.2 * p["wide"] - 0.16 * p["brow_frown"]
    top = 0.98 + raise_ * (1 - 0.4 * s * inner) + 0.5 * inner * tilt * s * 0.4
    crease = np.where(below, -0.95 - 0.1 * p["squint"], top) * np.maximum(1 - s * s, 0) ** 0.5
    radius = _ball_radius(name) * (1 + 0.06 * p["wide"])
    rows = []
    for t, size in ((1.0, 1.06), (0.5, 1.17), (0.0, 1.10)):
        a, e = 0.98 * s * (1 + 0.12 * t), edge + t * (crease - edge)
        direction = np.stack([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)], axis=1)
        rows.append(size * radius * direction)
    return np.stack(rows)


def ball(name, p):
    """Return an eyeball: rings from its pupil to its back, and a glint, in its own axes, (N, 3)."""
    lon, lat = np.deg2rad(SITES[name].at)
    around = 2 * np.pi * np.arange(SPOKES[name]) / SPOKES[name]
    angles = BALL_RINGS.copy()
    angles[:2] *= 1 + 0.5 * p["pupil"]
    angles[2:4] *= 1 + 0.12 * p["pupil"]
    a, r = np.meshgrid(angles, around, indexing="ij")
    points = np.stack([np.sin(a) * np.cos(r), np.sin(a) * np.sin(r), np.cos(a)], -1).reshape(-1, 3)
    glint = np.column_stack([GLINT * [-1, 1], np.sqrt(1 - (GLINT**2).sum(axis=1))])
    points = np.concatenate([points, 1.015 * glint[::-1]])
    points *= _ball_radius(name) * (1 + 0.06 * p["wide"])
    yaw, pitch = 0.5 * p["gaze_x"] - 0.4 * lon, 0.4 * p["gaze_y"] - 0.4 * lat
    y = points[:, 1] * np.cos(pitch) + points[:, 2] * np.sin(pitch)
    z = points[:, 2] * np.cos(pitch) - points[:, 1] * np.sin(pitch)
    x = points[:, 0] * np.cos(yaw) + z * np.sin(yaw)
    return np.stack([x, y, z * np.cos(yaw) - points[:, 0] * np.sin(yaw)], axis=1)


def placed_mouth(name, p):
    """Return a mouth's rings, teeth and tongue about the planet's middle."""
    return [
        globe_grid.wrapped(SITES[name], part.reshape(-1, 3)[:, :2], 1 + part.reshape(-1, 3)[:, 2])
        for part in mouth(name, p)
    ]


def placed_eye(name, p):
    """Return an eye's lids and ball about the planet's middle, two (N, 3)."""
    frame = globe_grid.axes(SITES[name])
    centre = (1 - 0.42 * _ball_radius(name)) * frame[:, 2]
    return [centre + part.reshape(-1, 3) @ frame.T for part in (lids(name, p), ball(name, p))]
