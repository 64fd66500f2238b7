"""Move the skin: smooth displacement fields of jaw, cheeks, nose and brows."""

import numpy as np

HINGE = np.array([0.0, -18.0, -6.0])
JAW_ANGLE = np.deg2rad(21.0)


def smoothstep(low, high, x):
    """Return a smooth rise from 0 at low to 1 at high."""
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def bell(points, centre, radii):
    """Return a Gaussian bell of the given radii [mm] about a centre."""
    q = (points - np.asarray(centre, float)) / np.asarray(radii, float)
    return np.exp(-np.sum(q * q, axis=-1))


def jaw_motion(points, p):
    """Return the displacement of points fixed to the jaw: a turn about its hinge [mm].

    The hinge itself slides forwards as the jaw opens, as a real one does.
    """
    angle = JAW_ANGLE * p["jaw_open"]
    side = np.deg2rad(7.0) * p["jaw_side"]
    q = points - HINGE
    y = q[..., 1] * np.cos(angle) - q[..., 2] * np.sin(angle)
    z = q[..., 1] * np.sin(angle) + q[..., 2] * np.cos(angle)
    x = q[..., 0] * np.cos(side) + z * np.sin(side)
    z = z * np.cos(side) - q[..., 0] * np.sin(side) + 4.0 * p["jaw_open"]
    return np.stack([x, y, z], axis=-1) - q


def jaw_weight(points):
    """Return how much the skin follows the jaw, 0..1."""
    below = smoothstep(-52, -88, points[..., 1])
    front = smoothstep(-25, 38, points[..., 2] - 0.25 * np.abs(points[..., 0]))
    neck = smoothstep(-150, -112, points[..., 1] - 0.15 * points[..., 2])
    return below * front * neck


def skin(points, p):
    """Return the displacement of the skin far from lips and lids [mm].

    Parameters
    ----------
    points : (N, 3) float array, the neutral skin [mm]
    p : dict of expression parameters

    Returns
    -------
    displacement : (N, 3) float array [mm]
    """
    move = jaw_weight(points)[:, None] * jaw_motion(points, p)
    for side, smile in ((1, p["smile_l"]), (-1, p["smile_r"])):
        cheek = bell(points, (side * 39, -36, 60), (17, 15, 40))
        move += smile * cheek[:, None] * [side * 3.0, 6.5, 4.5]
        fold = bell(points, (side * 27, -55, 70), (7, 9, 40))
        move += smile * fold[:, None] * [side * 3.0, 3.0, -1.0]
        wing = bell(points, (side * 11, -44, 86), (7, 7, 14))
        move += wing[:, None] * [side * (0.8 * smile), 2.4 * p["upper_up"] + 0.8 * smile, 0]
        move += (
            p["squint"] * bell(points, (side * 36, -26, 68), (16, 11, 40))[:, None] * [0, 3, 1.5]
        )
    return move + brows(points, p)


def brows(points, p):
    """Return the displacement that the brows' muscles give the skin [mm]."""
    move = np.zeros_like(points)
    for side, name in ((1, "l"), (-1, "r")):
        inner = bell(points, (side * 15, 27, 72), (13, 19, 60))
        outer = bell(points, (side * 45, 27, 60), (18, 19, 60))
        middle = bell(points, (side * 30, 27, 66), (12, 19, 60))
        raised_inner, raised_outer = p[f"brow_inner_{name}"], p[f"brow_outer_{name}"]
        frown = p["brow_frown"]
        # frowning under a raised inner brow lifts less than the sum: the muscles oppose
        frown_down = frown * (1 - 0.35 * raised_inner)
        move += (raised_inner * inner)[:, None] * [0, 9.0, 1.0]
        move += (raised_outer * outer)[:, None] * [side * 0.6, 9.0, 0.4]
        move += ((raised_inner + raised_outer) / 2 * middle)[:, None] * [0, 2.6, 0.4]
        move += (frown_down * inner)[:, None] * [-side * 4.6, -5.6, 1.6]
        move += (frown * middle)[:, None] * [-side * 2.0, -3.0, 0.4]
        move += (p["wide"] * (inner + outer + middle) / 2)[:, None] * [0, 1.6, 0]
    return move
