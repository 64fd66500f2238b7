"""What is known of a curve at the two ends of a gap, as features of one unit: the curve's own.

Slopes are measured over the same times whatever the frame rate, and counted as the change that
they would make over the gap. Every feature grows in proportion to the curves, so that what is
learnt from large motion holds for small.
"""

import itertools

import numpy as np

# slopes are measured over one, two and three of these
STEP_S = 1 / 30
LAGS = 3
# change over the gap and first slopes; further slopes; products of three; harmonic means with the
# change; shares of activity
COUNT = 3 + 2 * (LAGS - 1) + 10 + 2 + 6


def slopes(values: np.ndarray, row: int, side: int, rate: float) -> np.ndarray:
    """Return the slopes of curves outside a gap.

    A slope whose other end is not observed takes the value of the shorter one, the first 0.

    Parameters
    ----------
    values : (T, ..., K) float array; NaN where not observed
    row : the frame at the edge of the gap
    side : -1 where the curve lies before the gap, 1 where it lies after it
    rate : frames per second

    Returns
    -------
    (LAGS, ..., K) float array [per second]
    """
    made = np.zeros((LAGS, *values.shape[1:]))
    for lag in range(1, LAGS + 1):
        place = row + side * lag * STEP_S * rate
        below = int(np.floor(place + 1e-9))
        share = max(place - below, 0.0)
        share = share if share > 1e-9 else 0.0
        above = below + (share > 0.0)
        made[lag - 1] = made[max(lag - 2, 0)]
        if below < 0 or above >= len(values):
            continue
        outer = (1.0 - share) * values[below] + share * values[above]
        slope = side * (outer - values[row]) / (lag * STEP_S)
        made[lag - 1] = np.where(np.isfinite(slope), slope, made[lag - 1])
    return made


def features(
    values: np.ndarray, before: int, after: int, rate: float, longest_s: float = np.inf
) -> np.ndarray:
    """Describe the ends of a gap, or of several of one length.

    Parameters
    ----------
    values : (T, ..., K) float array, finite in the rows `before` and `after`; what moves at once
        stands along the last axis
    before, after : the frames at the edges of the gap
    rate : frames per second
    longest_s : slopes count as the change over the gap, but not over more than this [s]

    Returns
    -------
    (..., K, COUNT) float array [unit of the curves]
    """
    span_s = min((after - before) / rate, longest_s)
    left = span_s * slopes(values, before, -1, rate)
    right = span_s * slopes(values, after, 1, rate)
    change = values[after] - values[before]
    parts = np.stack([left[0], right[0], change])
    size = np.sqrt(np.sum(parts**2, axis=0))
    share = parts / np.where(size > 0.0, size, 1.0)
    threes = itertools.combinations_with_replacement(range(3), 3)
    bent = [size * share[i] * share[j] * share[k] for i, j, k in threes]
    # what a monotone cubic takes for the slope at an end (Fritsch & Butland 1984)
    calm = [_harmonic(part, change) for part in parts[:2]]
    # how much of the whole face moves before the gap, and after it
    activity = np.sqrt(np.mean(parts**2, axis=-1, keepdims=True))
    whole = np.sqrt(np.sum(activity**2, axis=0))
    moving = activity[:2] / np.where(whole > 0.0, whole, 1.0)
    gated = [part * one for part in parts for one in moving]
    return np.stack([*parts, *left[1:], *right[1:], *bent, *calm, *gated], axis=-1)


def _harmonic(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the harmonic mean of numbers of one sign, else 0."""
    alike = one * other > 0.0
    return np.where(alike, 2.0 * one * other / np.where(alike, one + other, 1.0), 0.0)
