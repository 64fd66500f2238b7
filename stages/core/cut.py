"""Which frames of a take an editor wants."""

from fractions import Fraction

import numpy as np


def delivered(
    frames: np.ndarray,
    rate: Fraction,
    first: int | None,
    last: int | None,
    handles: int,
    cut_rate: Fraction,
) -> np.ndarray:
    """Say which frames lie between the first and the last that are wanted, with handles.

    Frame n of a rate r stands at n / r seconds; the comparison is exact.

    Parameters
    ----------
    frames : (T,) int array, frame numbers of the take
    rate : its frames per second
    first, last : frame numbers at the cut's rate, or None for the ends of the take
    handles : frames at the cut's rate that are wanted before the first and after the last
    cut_rate : frames per second in which the cut is counted

    Returns
    -------
    (T,) bool array

    Raises
    ------
    ValueError
        if the last comes before the first, or no frame of the take lies between them
    """
    if first is not None and last is not None and last < first:
        raise ValueError(f"the last frame {last} comes before the first {first}")
    scale = Fraction(rate) / Fraction(cut_rate)
    kept = np.ones(len(frames), bool)
    if first is not None:
        start = (first - handles) * scale
        kept &= frames * start.denominator >= start.numerator
    if last is not None:
        end = (last + handles) * scale
        kept &= frames * end.denominator <= end.numerator
    if not kept.any():
        raise ValueError(f"frames {first} to {last} lie outside the take")
    return kept
