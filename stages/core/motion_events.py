"""Moments of a performance that smoothing must not touch: blinks and lip closures.

A blink is an excursion of a curve that is neither a spike nor a plateau: what an opening by
`SHORTEST_S` keeps and an opening by `LONGEST_S` takes away (a top-hat between two widths, of
grey-value morphology), well above the curve's noise. A lip closure begins and ends where the
distance of two points of the lips passes the level where they nearly touch.
"""

import numpy as np

from stages.core import multiresolution

SHORTEST_S = 0.04
LONGEST_S = 0.6
# times the noise of what the top-hat sees: white noise alone reaches five to six
ABOVE_NOISE = 9.0
# of the curve's largest excursions: less is a twitch
OF_LARGEST = 0.25
# of the distance between lips touching and lips open
NEAR_CLOSED = 0.2
# around what was found: the rest of a blink or closure, then the cross-fade
MARGIN_S = 0.08
FADE_S = 0.06


def noise(values: np.ndarray) -> np.ndarray:
    """Return the standard deviation of each curve's jitter from its median absolute deviation.

    Frames without any change do not count: a weight that rests on its limit says nothing.

    Parameters
    ----------
    values : (T, N) float array, a band of frequencies

    Returns
    -------
    (N,) float array
    """
    moving = np.where(values == 0.0, np.nan, np.abs(values))
    silent = np.isnan(moving).all(axis=0)
    return np.nanmedian(np.where(silent, 0.0, moving), axis=0) / 0.6745


def excursions(values: np.ndarray, rate: float) -> np.ndarray:
    """Find where a curve leaves its level briefly, upwards or downwards.

    Parameters
    ----------
    values : (T, N) float array, finite
    rate : frames per second

    Returns
    -------
    (T, N) bool array
    """
    high, calm = multiresolution.bands(values, 1)
    # white noise of the curve, and what the first smoothing leaves of it
    taps = multiresolution.TAPS
    left = np.sqrt(np.sum(taps**2) / (1 - 2 * taps[2] + np.sum(taps**2)))
    level = ABOVE_NOISE * left * noise(high)
    widths = (_frames(SHORTEST_S, rate), _frames(LONGEST_S, rate))
    found = np.zeros(values.shape, bool)
    for side in (calm, -calm):
        short, long = (_opened(side, width) for width in widths)
        apart = short - long
        largest = OF_LARGEST * np.quantile(apart, 0.999, axis=0, method="higher")
        # nothing moves by less than the arithmetic rounds
        found |= apart > np.maximum(np.maximum(level, largest), 1e-9 * np.abs(calm).max(axis=0))
    return found


def closures(gap: np.ndarray) -> np.ndarray:
    """Find where the lips meet and where they part.

    Between the two nothing is fast, so nothing has to be kept.

    Parameters
    ----------
    gap : (T,) float array, distance of two points of the lips; NaN where not observed

    Returns
    -------
    (T,) bool array, no frame if the distance never changes by more than its noise
    """
    known = np.isfinite(gap)
    if not known.any():
        return known
    spanned = np.interp(np.arange(len(gap)), np.flatnonzero(known), gap[known])[:, None]
    high, calm = multiresolution.bands(spanned, 1)
    closed, opened = np.quantile(calm, [0.01, 0.95])
    if opened - closed <= ABOVE_NOISE * noise(high)[0]:
        return np.zeros(len(gap), bool)
    touching = spanned[:, 0] <= closed + NEAR_CLOSED * (opened - closed)
    return np.diff(touching, prepend=touching[0]) & known


def envelope(found: np.ndarray, rate: float) -> np.ndarray:
    """Return how far each frame belongs to an event: 1 in it and round it, fading smoothly to 0.

    Parameters
    ----------
    found : (T, N) bool array
    rate : frames per second

    Returns
    -------
    (T, N) float array in 0..1
    """
    fade = _frames(FADE_S, rate)
    reach = _frames(MARGIN_S, rate) + fade
    window = np.hanning(2 * fade + 3)[1:-1]
    padded = np.pad(found, ((reach + fade,) * 2, (0, 0)))
    wide = -_lowest(-padded.astype(float), 2 * reach + 1)
    faded = np.zeros(found.shape)
    for shift, weight in enumerate(window / window.sum()):
        faded += weight * wide[shift : shift + len(found)]
    return np.minimum(faded, 1.0)


def _frames(seconds: float, rate: float) -> int:
    """Return a length of time in whole frames, at least one."""
    return max(round(seconds * rate), 1)


def _opened(values: np.ndarray, width: int) -> np.ndarray:
    """Return the grey-value opening of the columns (T, N): peaks below a width are cut off."""
    padded = np.pad(values, ((width - 1,) * 2, (0, 0)), mode="edge")
    return -_lowest(-_lowest(padded, width), width)


def _lowest(values: np.ndarray, width: int) -> np.ndarray:
    """Return the minimum of every `width` rows that follow each other, (T - width + 1, N)."""
    made, covered = values, 1
    while covered < width:
        step = min(covered, width - covered)
        made, covered = np.minimum(made[:-step], made[step:]), covered + step
    return made
