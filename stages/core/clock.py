"""Series on a constant clock: `time_s = frame / rate`, frame 0 at the first picture."""

from fractions import Fraction

import numpy as np


def frame_times(count: int, rate: Fraction) -> np.ndarray:
    """Return the times of frames 0 to count - 1 [s], each rounded once."""
    return np.array([float(frame / rate) for frame in range(count)])


def frame_count(last_time_s: float, rate: Fraction) -> int:
    """Return how many frames of a rate lie within a series, its last time included.

    Half a frame of slack keeps the last picture where presentation times are rounded.
    """
    return int(np.floor(last_time_s * float(rate) + 0.5)) + 1


def resample(values: np.ndarray, time_s: np.ndarray, wanted_s: np.ndarray) -> np.ndarray:
    """Interpolate a series linearly; a time beside an unobserved value is unobserved.

    Parameters
    ----------
    values : (T, N) float array; NaN where not observed
    time_s : (T,) float array [s], ascending
    wanted_s : (S,) float array [s]

    Returns
    -------
    (S, N) float array; a wanted time before the first or after the last takes that value

    Raises
    ------
    ValueError
        if the times do not ascend or the lengths differ
    """
    if values.shape[0] != len(time_s) or np.any(np.diff(time_s) <= 0):
        raise ValueError(f"expected ascending times for {values.shape} values, got {time_s.shape}")
    if len(time_s) == 1:
        return np.repeat(values, len(wanted_s), axis=0)
    after = np.clip(np.searchsorted(time_s, wanted_s), 1, len(time_s) - 1)
    start, end = time_s[after - 1], time_s[after]
    share = np.clip((wanted_s - start) / (end - start), 0, 1)[:, None]
    # a value that has no part in the result must not pass its NaN on
    before = np.where(share < 1, values[after - 1] * (1 - share), 0)
    return before + np.where(share > 0, values[after] * share, 0)
