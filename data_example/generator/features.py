"""Draw mouths and lids of characters from the actor's expression parameters, each in its units.

A character's rig is its own: these curves are flat, with gains for each character.
"""

from typing import NamedTuple

import numpy as np

from data_example.generator import fields


class Gains(NamedTuple):
    """How strongly a character's mouth answers; lengths in halves of its neutral width.

    jaw : drop of the lower lip at full jaw opening
    corner : share of that drop that the corners make
    lift : raise of the upper lip
    drop : drop of the lower lip without the jaw
    out, up : way of a corner in a full smile
    narrow : share of its width that a full pucker takes
    """

    jaw: float = 1.2
    corner: float = 0.35
    lift: float = 0.22
    drop: float = 0.24
    out: float = 0.24
    up: float = 0.34
    narrow: float = 0.42


def lips(p, along, gains):
    """Return the inner edges of upper and lower lip, which touch when the mouth is closed.

    Parameters
    ----------
    p : dict of expression parameters
    along : (N,) float array, place from the right corner, -1, to the left one, 1
    gains : Gains

    Returns
    -------
    upper, lower : (N, 2) float arrays [half widths of the neutral mouth], y from its line
    """
    s = np.asarray(along, float)
    arch = np.maximum(1 - np.abs(s) ** 2.6, 0) ** 0.62
    half = (1 - gains.narrow * p["pucker"]) * (1 - 0.26 * p["funnel"])
    half += 0.20 * p["stretch"] - 0.10 * p["jaw_open"]
    left = fields.smoothstep(-0.3, 0.3, s)
    smile = p["smile_r"] + left * (p["smile_l"] - p["smile_r"])
    end = np.abs(s) ** 1.6
    x = s * half + np.sign(s) * end * gains.out * smile * (1 - 0.5 * p["pucker"])
    y = end * (gains.up * smile - 0.27 * p["frown"]) - 0.05 * smile
    jaw = gains.jaw * np.sin(np.deg2rad(60) * p["jaw_open"]) / np.sin(np.deg2rad(60))
    upper = y - gains.corner * jaw * (1 - arch)
    lower = y - (gains.corner + (1 - gains.corner) * arch) * jaw
    upper = upper + arch * gains.lift * (p["upper_up"] + 0.6 * p["funnel"])
    lower = lower - arch * gains.drop * (p["lower_down"] + 0.6 * p["funnel"])
    meet = 0.6 * upper + 0.4 * lower
    close = p["lip_close"]
    upper, lower = upper + close * (meet - upper), lower + close * (meet - lower)
    middle = (upper + lower) / 2
    crossed = upper < lower
    upper, lower = np.where(crossed, middle, upper), np.where(crossed, middle, lower)
    sideways = 0.22 * p["jaw_side"] * np.stack([0.4 * arch, 0.25 + 0.75 * arch])
    return np.stack([x + sideways[0], upper], 1), np.stack([x + sideways[1], lower], 1)


def fullness(p):
    """Return the factor on the thickness of lips."""
    smile = (p["smile_l"] + p["smile_r"]) / 2
    thin = 1 - 0.2 * smile - 0.25 * p["stretch"] - 0.7 * p["press"]
    return thin + 0.2 * p["pucker"] + 0.25 * p["funnel"]


def forward(p):
    """Return how far the lips are pushed out, 0..1."""
    return 0.9 * p["pucker"] + 0.5 * p["funnel"] - 0.2 * p["press"]


def lid_heights(p, side, upper=0.62, lower=-0.6, shut=-0.3):
    """Return the heights of the lids' edges in the middle of the eye, in its half heights.

    Parameters
    ----------
    p : dict of expression parameters
    side : "l" or "r"
    upper, lower : heights of the neutral lids
    shut : height at which they meet
    """
    blink = p[f"blink_{side}"]
    high = upper + 0.26 * p["wide"] - 0.16 * p["squint"]
    low = lower - 0.06 * p["wide"] + 0.26 * p["squint"]
    return high + blink * (shut - high), low + blink * (shut - low)


def brow(p, side, along):
    """Return the displacement of a brow, (N, 2), in its own length.

    Parameters
    ----------
    p : dict of expression parameters
    side : "l" or "r"
    along : (N,) float array, 0 at the outer end, 1 at the inner end
    """
    t = np.asarray(along, float)
    inward = -1.0 if side == "l" else 1.0
    inner, outer = p[f"brow_inner_{side}"], p[f"brow_outer_{side}"]
    frown = p["brow_frown"]
    up = 0.34 * (inner * t**1.2 + outer * (1 - t) ** 1.2) + 0.05 * p["wide"]
    up = up - frown * (1 - 0.3 * inner) * (0.28 * t**1.5 + 0.02)
    return np.stack([inward * 0.17 * frown * (0.3 + 0.7 * t), up], axis=1)
