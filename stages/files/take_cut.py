"""What an editor asks of a take in shots.tsv: the first and last frame, handles, the timecode."""

from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.core import cut, timecode
from stages.files import errors


def kept(
    path: str | Path,
    frames: np.ndarray,
    rate: Fraction,
    cells: tuple[str, str, str],
    cut_rate: Fraction,
) -> np.ndarray:
    """Return which frames the cut wants.

    Parameters
    ----------
    path : the take, for the error
    frames : (T,) int array
    rate : frames for each second of the performance
    cells : first frame, last frame and handles, each perhaps empty, in frames of the film
    cut_rate : the film's frames per second

    Raises
    ------
    errors.InputError
        if the cut lies outside the take or ends before it begins
    """
    first, last, handles = (int(text) if text else None for text in cells)
    try:
        return cut.delivered(frames, rate, first, last, handles or 0, cut_rate)
    except ValueError as error:
        end = frames[-1] * cut_rate // rate
        message = f"{error}: the take ends with frame {end}, correct the cut in shots.tsv"
        raise errors.InputError(path, message) from error


def timecode_header(start_timecode: str, cut_rate: Fraction) -> dict:
    """Return what the weights say of the timecode of the film's first picture.

    Raises
    ------
    errors.InputError
        if the text is no timecode of the rate
    """
    if not start_timecode:
        return {}
    try:
        timecode.parse(start_timecode, cut_rate)
    except ValueError as error:
        message = f"{error}: correct start_timecode in shots.tsv"
        raise errors.InputError("--start-timecode", message) from error
    return {"start_timecode": start_timecode, "timecode_rate": str(cut_rate)}
