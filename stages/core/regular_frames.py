"""Values that were measured at almost regular times, put on frames of a constant rate."""

from fractions import Fraction

import numpy as np

from stages.core import clock, cubic_resample, frame_clock

SLACK = 0.25  # of a frame: measurements this near to their frames are taken as they are


def regular(
    values: np.ndarray, time_s: np.ndarray, rate: Fraction
) -> tuple[np.ndarray, np.ndarray]:
    """Put rows on frames of a constant rate; the first row is frame 0.

    Rows that are missing between others, or that hold NaN, are filled by straight lines, and all
    others stay at their times. Where all rows lie on frames they come back unchanged; where the
    measuring clock runs differently they are interpolated by cubics, so that nothing drifts.

    Parameters
    ----------
    values : (T, C) float array; a row with NaN counts as missing
    time_s : (T,) float array [s], rising
    rate : frames per second

    Returns
    -------
    values : (F, C) float array
    measured : (F,) bool array, False where a row is filled

    Raises
    ------
    ValueError
        if no row is without NaN, or the rows stand for too many frames
    """
    known = np.isfinite(values).all(axis=1)
    if not known.any():
        raise ValueError("holds no frame without blanks")
    elapsed = time_s - time_s[0]
    count = clock.frame_count(elapsed[-1], rate)
    frame_clock.check_span(len(time_s), count)
    steps = np.diff(elapsed)
    # one frame of the measuring clock: where many rows are lost, most steps are of several
    single = steps[np.rint(steps * float(rate)) == 1]
    one = np.median(single if len(single) else steps) if len(steps) else 1.0
    counts = np.maximum(np.rint(steps / one), 1)
    row = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    dense = np.arange(row[-1] + 1)
    measured = np.zeros(len(dense), bool)
    measured[row[known]] = True
    filled = np.stack([np.interp(dense, row[known], v) for v in values[known].T], axis=1)
    wanted = clock.frame_times(count, rate)
    place = np.interp(wanted, np.interp(dense, row, elapsed), dense)
    if (np.abs(place - np.rint(place)) <= SLACK).all():
        place = np.rint(place)
    at = cubic_resample.places(place, len(dense))
    whole = cubic_resample.smallest(measured.astype(float), at) > 0
    return np.stack([cubic_resample.cubic(v, at) for v in filled.T], axis=1), whole
