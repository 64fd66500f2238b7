"""Bring series of constant rate to other times by cubic interpolation between four samples.

A line between two samples takes detail away that a cubic keeps: at 120 samples a second, half
way between two, a motion of 20 Hz keeps 87 % of its size on the line and 97 % on the cubic.
"""

import dataclasses

import numpy as np

SAME = 1e-5  # of a sample: rounding of times, far below any motion


@dataclasses.dataclass(frozen=True)
class Places:
    """Where wanted times lie among the samples of a series.

    Attributes
    ----------
    below : (S,) int array, sample at or before; where there is one after it, it is used
    share : (S,) float array in 0..1 of the sample after it
    inside : (S,) bool array, whether the time lies within the series
    count : samples of the series
    """

    below: np.ndarray
    share: np.ndarray
    inside: np.ndarray
    count: int


def places(wanted: np.ndarray, count: int) -> Places:
    """Place wanted times, in samples after the first, among the samples of a series.

    Parameters
    ----------
    wanted : (S,) float array [samples]
    count : samples of the series
    """
    whole = np.round(wanted)
    wanted = np.where(np.abs(wanted - whole) < SAME, whole, wanted)
    below = np.clip(np.floor(wanted), 0, max(count - 2, 0)).astype(np.int64)
    inside = (wanted >= 0) & (wanted <= count - 1)
    return Places(below, np.clip(wanted - below, 0.0, 1.0), inside, count)


def cubic(values: np.ndarray, at: Places) -> np.ndarray:
    """Interpolate by the cubic through the two samples on either side (Lagrange).

    Beside the ends and beside gaps it is the line between the two neighbours.

    Parameters
    ----------
    values : (T,) float array; NaN where not observed
    at : the wanted places

    Returns
    -------
    (S,) float array; the samples themselves where a place is one, NaN outside the series and where
    a neighbour is not observed
    """
    last, s = at.count - 1, at.share
    start, end = values[at.below], values[np.minimum(at.below + 1, last)]
    before, after = values[np.maximum(at.below - 1, 0)], values[np.minimum(at.below + 2, last)]
    curved = (at.below >= 1) & (at.below + 2 <= last) & np.isfinite(before) & np.isfinite(after)
    line = (1 - s) * start + s * end
    curve = (
        (s + 1) * (s - 1) * (s - 2) / 2 * start
        - (s + 1) * s * (s - 2) / 2 * end
        - s * (s - 1) * (s - 2) / 6 * before
        + (s + 1) * s * (s - 1) / 6 * after
    )
    between = np.where(curved, curve, line)
    found = np.where(s == 0, start, np.where(s == 1, end, between))
    return np.where(at.inside, found, np.nan)


def largest(values: np.ndarray, at: Places) -> np.ndarray:
    """Return the larger of the two neighbours' values, (S,); 0 outside the series."""
    return _chosen(values, at, np.maximum)


def smallest(values: np.ndarray, at: Places) -> np.ndarray:
    """Return the smaller of the two neighbours' values, (S,); 0 outside the series."""
    return _chosen(values, at, np.minimum)


def _chosen(values: np.ndarray, at: Places, choose: np.ufunc) -> np.ndarray:
    """Return a choice from the two neighbours' values, or the sample itself."""
    start, end = values[at.below], values[np.minimum(at.below + 1, at.count - 1)]
    found = np.where(at.share == 0, start, np.where(at.share == 1, end, choose(start, end)))
    return np.where(at.inside, found, 0)
