"""Model what the tortoise has besides its skin: eyes, lids, brow ridges, tongue, shell; in cm."""

import numpy as np

from data_example.generator import modelling, tortoise

SIDES = (("r", -1.0), ("l", 1.0))
EYE = np.array([4.9, 4.0, 4.1])
# the eyes look outwards by so much at rest
YAW, PITCH = np.deg2rad(30.0), np.deg2rad(2.0)
BALL = 2.8
SPOKES, BALL_ANGLES = 10, np.array([0.30, 0.34, 0.66, 0.72, 1.55])
LIDS, LID_ROWS = 14, 6
LID_ANGLE = 2 * np.pi * np.arange(LIDS) / LIDS
LID_ACROSS, LID_UP = -np.cos(LID_ANGLE), np.arange(LIDS) > LIDS // 2
# the directions in which the lids end behind the ball
ROOT = np.stack([0.81 * LID_ACROSS, -0.81 * np.sin(LID_ANGLE), 0 * LID_ANGLE - 0.59], axis=1)
UPPER, UNDER, SHUT = 0.40, -0.62, -0.34
RIDGE, RIDGE_ROWS = 7, 5
TONGUE = (4, 5)
SHELL_COLUMNS = 20
# z, half width, middle, half height of each ring of the shell, from its dark inside to its end
SHELL = np.array([
    (-16.2, 3.0, -14.5, 2.0), (-10.7, 6.2, -13.4, 4.4), (-8.2, 6.6, -13.2, 4.9),
    (-7.5, 7.4, -13.0, 5.6), (-8.4, 10.0, -12.4, 7.4), (-9.8, 9.8, -12.0, 7.4),
    (-11.6, 10.3, -11.2, 8.5), (-15.7, 10.4, -10.8, 9.0), (-20.2, 8.8, -11.6, 7.6),
    (-23.7, 4.0, -13.0, 3.8),
])  # fmt: skip


def _to_head(points, out):
    """Return points of an eye's own axes, z where it looks, in the head's [cm]."""
    y = points[..., 1] * np.cos(PITCH) + points[..., 2] * np.sin(PITCH)
    z = points[..., 2] * np.cos(PITCH) - points[..., 1] * np.sin(PITCH)
    turn = out * YAW
    x = points[..., 0] * np.cos(turn) + z * np.sin(turn)
    z = z * np.cos(turn) - points[..., 0] * np.sin(turn)
    return EYE * [out, 1, 1] + np.stack([x, y, z], axis=-1)


def _toward(azimuth, elevation):
    """Return unit directions, (..., 3)."""
    flat = np.cos(elevation)
    return np.stack([np.sin(azimuth) * flat, np.sin(elevation), np.cos(azimuth) * flat], axis=-1)


def _look(points, out, p):
    """Return points of an eye turned by its gaze [cm]; at rest it looks a little inwards."""
    yaw, pitch = 0.42 * p["gaze_x"] - 0.20 * out, 0.36 * p["gaze_y"]
    y = points[:, 1] * np.cos(pitch) + points[:, 2] * np.sin(pitch)
    z = points[:, 2] * np.cos(pitch) - points[:, 1] * np.sin(pitch)
    x = points[:, 0] * np.cos(yaw) + z * np.sin(yaw)
    return np.stack([x, y, z * np.cos(yaw) - points[:, 0] * np.sin(yaw)], axis=1)


def ball(out, p):
    """Return an eyeball: rings round the gaze, then its pole, (51, 3) [cm]."""
    around = 2 * np.pi * np.arange(SPOKES) / SPOKES
    a, r = np.meshgrid(BALL_ANGLES, around, indexing="ij")
    rings = np.stack([np.sin(a) * np.cos(r), np.sin(a) * np.sin(r), np.cos(a)], -1)
    # behind the lids it is a little smaller, lest it come through them
    rings[-1] *= 0.95
    points = np.vstack([rings.reshape(-1, 3), [0, 0, 1]]) * BALL
    return _to_head(_look(points, out, p), out)


def glint(out, p):
    """Return the light in an eye, (4, 3) [cm]; it stays at the same side of both eyes."""
    angle = np.pi * np.arange(4) / 2
    size = 0.11
    points = _toward(-0.22 + size * np.cos(angle), 0.24 + size * np.sin(angle)) * (BALL + 0.06)
    return _to_head(_look(points, out, p), out)


def lids(name, out, p):
    """Return the lids' rings from the ball to deep in the head, (LID_ROWS * LIDS, 3) [cm]."""
    s, u = LID_ACROSS, out * LID_ACROSS
    blink = p[f"blink_{name}"]
    slant = p["slant"] * u * (1 - 0.5 * blink)
    high, low = UPPER + p[f"lid_{name}"], UNDER + p[f"under_{name}"]
    arch = np.maximum(1 - s * s, 0) ** 0.62
    fringe = np.where(LID_UP, np.maximum(high + slant, low + 0.3 * slant), low + 0.3 * slant)
    meet = SHUT + slant
    fringe = (fringe + blink * (meet - fringe)) * arch
    # heavy lids: what is drawn up folds over the edge, what comes down bulges
    crease = np.where(LID_UP, 1.18, -1.04) * np.maximum(1 - s * s, 0) ** 0.5
    heavy = np.where(LID_UP, 0.26, 0.12)
    rows = [
        _toward(1.00 * s, fringe) * (BALL + 0.06),
        _toward(1.00 * s, fringe) * (BALL + 0.40 + heavy * arch)[:, None],
        _toward(1.04 * s, fringe + 0.35 * (crease - fringe))
        * (BALL + 0.52 + 1.1 * heavy * arch)[:, None],
        _toward(1.12 * s, fringe + 0.75 * (crease - fringe)) * (BALL + 0.50),
        _toward(1.36 * s, crease) * (BALL + 0.46),
        ROOT * (BALL + 0.40),
    ]
    return _to_head(np.concatenate(rows), out)


def ridge(name, out, p):
    """Return a brow ridge, a horny roll over an eye, (RIDGE_ROWS * RIDGE, 3) [cm]."""
    t = np.linspace(-1, 1, RIDGE)
    inner, outer = (1 - t) / 2, (1 + t) / 2
    up = p[f"inner_{name}"] * inner**1.2 + p[f"outer_{name}"] * outer**1.2
    up = up * (1.1 - 0.45 * t**4)
    azimuth = out * (1.26 * t - 0.10 - 0.30 * p["knit"] * inner)
    elevation = 0.94 - 0.20 * t * t - 0.08 * inner + 0.30 * up - 0.38 * p["knit"] * inner**1.4
    taper = np.maximum(1 - np.abs(t) ** 3, 0) ** 0.5 * (1 + 0.15 * inner)
    reach = BALL + 0.55 + 0.5 * taper
    # the roll's lower edge half stays on the lid, as if skin stretched between them
    rows = [_toward(out * 1.26 * t, 0.82 - 0.20 * t * t + 0.18 * up) * (BALL + 0.35)]
    rows[0][:, 1] += 0.30 * up
    for rise, depth in ((-0.20, 0.10), (-0.03, 0.46), (0.19, 0.14), (0.42, -1.0)):
        swell = reach + depth * (0.35 + 0.65 * taper)
        rows.append(_toward(azimuth, elevation + rise * taper) * swell[:, None])
        rows[-1][:, 1] += 0.55 * up
    return _to_head(np.concatenate(rows), out)


def tongue(p):
    """Return the tongue, carried by the jaw, (20, 3) [cm]; its last row is the tip."""
    rows, columns = TONGUE
    x = np.linspace(-1, 1, columns)
    points = []
    for t in np.linspace(0, 1, rows):
        half = 3.0 * (1 - 0.45 * t**3)
        y = -1.9 + 0.8 * t - 0.5 * t**4 + 0.35 * (1 - x**2)
        points.append(np.column_stack([half * x, y, 1.5 + 6.3 * t - 1.0 * t * x**2]))
    points = np.concatenate(points)
    share = np.repeat(np.linspace(0, 1, rows) ** 1.5, columns)[:, None]
    carried = points + jaw_share(p) * tortoise.jaw(points, p)
    lift = 0.5 + 2.6 * p["jaw"]
    return carried + share * [
        0.0,
        p["tongue"] * lift + 1.3 * p["lick"],
        4.2 * p["lick"] + 0.4 * p["tongue"],
    ]


def jaw_share(p):
    """Return how much of the jaw's turn the tongue follows; a lifted one follows less."""
    return 0.95 - 0.15 * p["tongue"]


def shell(p):
    """Return the shell, rings from its dark inside over the rim to its end, (R * C, 3) [cm]."""
    angle = 2 * np.pi * np.arange(SHELL_COLUMNS) / SHELL_COLUMNS + np.pi / 2
    c, s = np.cos(angle), np.sin(angle)
    # domed above, flat below; scutes of the rim stand out a little, one by one
    high = np.where(s > 0, s, -0.62 * np.abs(s) ** 0.7)
    scallop = np.where(np.arange(SHELL_COLUMNS) % 2, 1.0, 1.035)
    z, half, middle, height = (column[:, None] for column in SHELL.T)
    ragged = np.where((np.arange(len(SHELL)) == 4)[:, None], scallop, 1.0)
    points = np.stack(
        [half * ragged * c, middle + height * ragged * high, z - 1.2 * np.maximum(s, 0) + 0 * c],
        axis=-1,
    )
    tilt = np.deg2rad(7.0) * p["lean"]
    points = points.reshape(-1, 3)
    x = points[:, 0] * np.cos(tilt) - (points[:, 1] + 14) * np.sin(tilt)
    y = points[:, 0] * np.sin(tilt) + (points[:, 1] + 14) * np.cos(tilt) - 14
    return np.column_stack([x, y, points[:, 2]]) + tortoise.shell_way(p)


def closed_quads(rows, columns, first_cap=False, last_cap=False):
    """Return quads of rows of rings, capped by quads across the ring if asked, (F, 4)."""
    faces = modelling.grid(rows, columns, closed=True)
    for wanted, row, way in ((first_cap, 0, 1), (last_cap, rows - 1, -1)):
        if wanted:
            ring = list(range(row * columns, (row + 1) * columns))
            cap = [
                (ring[i], ring[-1 - i], ring[-2 - i], ring[i + 1]) for i in range(columns // 2 - 1)
            ]
            faces += cap if way > 0 else modelling.flipped(cap)
    return faces


def pole_quads(count, centre):
    """Return quads from a centre to pairs of sides of a ring that starts at 0, (F, 4)."""
    return [(centre, i, i + 1, (i + 2) % count) for i in range(0, count, 2)]
