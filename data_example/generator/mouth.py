"""Shape the actor's lips: two curves for each lip, and the rings swept between them.

Rings run from the actor's right corner along the lower lip to the left corner and back along
the upper lip; the first and the middle sample are the corners.
"""

import numpy as np

from data_example.generator import fields

HALF = 36
COUNT = 2 * HALF
WIDTH = 25.0
LINE_Y = -70.0
FRONT_Z = 87.0
CURVE = 0.0205
_ANGLE = np.pi * np.arange(COUNT) / HALF
# position along the mouth, -1 at the right corner and 1 at the left one
ALONG = -np.cos(_ANGLE)
LOWER = np.arange(COUNT) <= HALF
INNER_RINGS = (
    (0.0, 0.0),
    (-0.25, 2.2),
    (-0.7, 5.0),
    (2.5, 10.0),
    (9.0, 16.0),
    (14.0, 34.0),
    (13.0, 60.0),
)
LIP_RINGS = (0.0, 0.12, 0.3, 0.5, 0.7, 0.88, 1.0)


def _openness(s):
    """Return the arch of the opening along the mouth, 0 at the corners, 1 in the middle."""
    return np.maximum(1 - np.abs(s) ** 2.8, 0) ** 0.62


def _heights(s, p):
    """Return the heights of the red of upper and lower lip at positions s [mm]."""
    smile = (p["smile_l"] + p["smile_r"]) / 2
    thin = 1 - 0.22 * smile - 0.30 * p["stretch"] - 0.72 * p["press"] + 0.10 * p["pucker"]
    end = np.maximum(1 - np.abs(s) ** 2.4, 0) ** 0.75
    bow = 1 - 0.16 * np.exp(-((s / 0.10) ** 2)) + 0.05 * np.exp(-(((np.abs(s) - 0.22) / 0.12) ** 2))
    upper = 7.6 * end * bow * (thin + 0.25 * p["funnel"] - 0.15 * p["upper_up"])
    full = np.maximum(1 - np.abs(s) ** 3.2, 0) ** 0.75
    lower = 9.4 * full * (thin + 0.22 * p["funnel"] - 0.10 * p["lower_down"])
    return upper, lower


def _corner(side, p):
    """Return the displacement of one mouth corner without the jaw [mm]."""
    smile = p["smile_l"] if side > 0 else p["smile_r"]
    round_ = 1 - (1 - 0.36 * p["pucker"]) * (1 - 0.24 * p["funnel"])
    out = 6.2 * smile * (1 - 0.5 * p["pucker"]) + 5.5 * p["stretch"] - WIDTH * round_
    out -= 3.0 * p["jaw_open"] * (1 - 0.5 * p["stretch"])
    up = 7.4 * smile * (1 - 0.4 * p["pucker"]) - 5.4 * p["frown"] - 0.8 * p["stretch"]
    back = -4.6 * smile - 3.2 * p["stretch"] + 5.5 * p["pucker"] + 3.0 * p["funnel"]
    return np.array([side * out, up, back])


def _rest_line(s):
    """Return the closed neutral line between the lips at positions s, (N, 3) [mm]."""
    x = WIDTH * s
    y = (
        LINE_Y
        - 0.5 * np.exp(-((s / 0.18) ** 2))
        + 0.7 * np.exp(-(((np.abs(s) - 0.42) / 0.25) ** 2))
    )
    return np.stack([x, y + 2.0 * s**4, FRONT_Z - CURVE * x * x], axis=-1)


def inner_curves(p):
    """Return the inner edges of both lips in one ring, (COUNT, 3) [mm].

    Where they would pass through each other they meet: contact is exact, and not linear.
    """
    s = ALONG
    arch = _openness(s)
    line = _rest_line(s)
    right, left = _corner(-1, p), _corner(1, p)
    blend = fields.smoothstep(-1, 1, s)[:, None]
    pull = np.abs(s)[:, None] ** 1.5
    line = line + pull * ((1 - blend) * right + blend * left)
    # between the corners the line is carried along in x, so that lips stay evenly stretched
    width = (left[0] - right[0]) / (2 * WIDTH)
    line[:, 0] = WIDTH * s * (1 + width) + (left[0] + right[0]) / 2 * (s * s)
    forward = 8.5 * p["pucker"] + 4.5 * p["funnel"] - 1.8 * p["press"]
    line[:, 2] += forward * (1 - 0.55 * s * s)
    jaw = fields.jaw_motion(line, p)
    upper = line + (0.42 * (1 - arch))[:, None] * jaw
    lower = line + (0.42 + 0.58 * arch)[:, None] * jaw
    smile = (p["smile_l"] + p["smile_r"]) / 2
    lift = 5.2 * p["upper_up"] + 3.0 * p["funnel"] + 1.2 * smile * p["jaw_open"]
    drop = 5.4 * p["lower_down"] + 3.4 * p["funnel"] * (1 - 0.4 * p["pucker"])
    upper[:, 1] += lift * arch
    lower[:, 1] -= drop * arch
    lower[:, 2] += 1.5 * p["lower_down"] * arch
    meet = 0.62 * upper + 0.38 * lower
    close = p["lip_close"]
    upper += close * (meet - upper)
    lower += close * (meet - lower)
    crossed = (upper[:, 1] < lower[:, 1])[:, None]
    middle = (upper + lower) / 2
    upper, lower = np.where(crossed, middle, upper), np.where(crossed, middle, lower)
    return np.where(LOWER[:, None], lower, upper)


def outer_curve(inner, p):
    """Return the outer border of the red of the lips in one ring, (COUNT, 3) [mm]."""
    upper, lower = _heights(ALONG, p)
    outer = inner.copy()
    outer[:, 1] += np.where(LOWER, -lower, upper)
    outer[:, 0] += 1.6 * ALONG * np.abs(ALONG) ** 6
    turned_out = p["funnel"] + 0.5 * p["pucker"]
    outer[:, 2] += np.where(LOWER, -1.6 - 0.4 * turned_out, -0.4) - 1.2 * turned_out * (
        1 - ALONG**2
    )
    return outer


def rings(p):
    """Return all rings of the mouth from the throat to the lips' outer border.

    Returns
    -------
    rings : (R, COUNT, 3) float array [mm]; the ring of the inner contour is number
        `len(INNER_RINGS) - 1`, the last one is the outer contour
    """
    inner = inner_curves(p)
    outer = outer_curve(inner, p)
    sign = np.where(LOWER, -1.0, 1.0)
    taper = np.maximum(1 - ALONG**4, 0) ** 0.5
    jaw = fields.jaw_motion(np.array([[0.0, LINE_Y, 60.0]]), p)[0, 1]
    result = []
    for step, depth in INNER_RINGS[:0:-1]:
        ring = inner.copy()
        ring[:, 1] += sign * step * taper
        ring[:, 2] -= depth
        if depth > 8:
            # the bag keeps its own height behind the lips, so that it never shows a seam
            ring[:, 0] *= 1.12
            spare = np.where(LOWER, jaw * 0.4, 0) * taper
            ring[:, 1] += np.where(LOWER, np.minimum(spare, 0), 0)
        if depth == INNER_RINGS[-1][1]:
            ring = ring.mean(axis=0) + 0.02 * (ring - ring.mean(axis=0))
        result.append(ring)
    fullness = (1 - 0.85 * p["press"]) * (1 + 0.25 * p["pucker"] + 0.2 * p["funnel"])
    for rho in LIP_RINGS:
        ring = inner + rho * (outer - inner)
        bulge = np.where(LOWER, 4.2, 2.9) * np.sqrt(taper) * fullness
        profile = np.sin(np.pi * rho**0.75) if rho < 1 else 0.0
        ring[:, 2] += bulge * profile
        result.append(ring)
    return np.stack(result)


INNER = len(INNER_RINGS) - 1
OUTER = INNER + len(LIP_RINGS) - 1
