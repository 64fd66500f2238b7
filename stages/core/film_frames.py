"""Put rows that another program measured on the pictures of a film that they belong to."""

import dataclasses
from fractions import Fraction

import numpy as np

from stages.core import clock, frame_clock

NEAR = 0.75  # of the step between pictures: times this far from a picture still mean it


@dataclasses.dataclass(frozen=True)
class Placement:
    """Where rows stand in a film.

    Attributes
    ----------
    frame : (F,) int array, pictures of the film from 0
    time_s : (F,) float array [s], 0 at the first picture
    row : (F,) int array, the row that was measured there; -1 for a gap
    """

    frame: np.ndarray
    time_s: np.ndarray
    row: np.ndarray


def on_film(
    picture_s: np.ndarray,
    count: int,
    frame: np.ndarray | None,
    first: int | None,
    time_s: np.ndarray | None,
) -> Placement:
    """Place rows on the pictures of a film, by their numbers, else their times, else their count.

    Parameters
    ----------
    picture_s : (N,) float array, times of the film's pictures [s]
    count : rows
    frame : (count,) int array, rising; None if rows have no numbers
    first : number of the film's first picture; None if it is not known
    time_s : (count,) float array, rising [s]; None if rows have no times

    Raises
    ------
    ValueError
        if numbers, times or count do not fit the film
    """
    pictures = len(picture_s)
    if frame is not None:
        start = first_number(frame, first, time_s)
        start += int(frame[-1] - start == pictures and frame[0] > start)
        own = frame - start
        if own[0] < 0 or own[-1] >= pictures:
            last = start + pictures - 1
            raise ValueError(f"has frames {frame[0]} to {frame[-1]}, the film {start} to {last}")
    elif time_s is not None:
        own = np.abs(picture_s[None] - time_s[:, None]).argmin(axis=1)
        near = NEAR * np.median(np.diff(picture_s)) if pictures > 1 else 0.0
        if (np.abs(picture_s[own] - time_s) > near).any():
            spans = f"{time_s[0]:.3f} to {time_s[-1]:.3f} s, the film 0 to {picture_s[-1]:.3f} s"
            raise ValueError(f"has times {spans}")
        if (np.diff(own) < 1).any():
            raise ValueError("two of its times mean the same picture of the film")
    elif count == pictures:
        own = np.arange(count)
    else:
        raise ValueError(f"has {count} rows without frame numbers, the film {pictures} pictures")
    grid, row = _gaps(own, pictures)
    return Placement(grid, picture_s[grid], row)


def alone(
    count: int,
    frame: np.ndarray | None,
    first: int | None,
    time_s: np.ndarray | None,
    rate: Fraction | None,
) -> tuple[Placement, Fraction]:
    """Place rows of which there is no film, and say their rate.

    Without frame numbers the first row is taken for the first picture. A rate that is given
    decides over the times of numbered rows.

    Parameters
    ----------
    count, frame, first, time_s : as in `on_film`
    rate : frames per second, if it is known

    Raises
    ------
    ValueError
        if there are neither rate nor times, or if numbers and times contradict each other
    """
    if rate is None and time_s is None:
        raise ValueError("has neither times nor a rate")
    if frame is None and time_s is None:
        frame, first = np.arange(count), 0
    found = rate or frame_clock.rate_of(time_s, frame)
    if frame is None:
        own = frame_clock.numbers(time_s, found)
    else:
        own = frame - first_number(frame, first, time_s)
        if own[0] < 0:
            raise ValueError(f"has frame {frame[0]} before the first, {first}")
    frame_clock.check_span(count, int(own[-1]) + 1)
    grid, row = _gaps(own, int(own[-1]) + 1)
    placed = clock.frame_times(int(grid[-1]) + 1, found)[grid]
    if time_s is not None and (rate is None or frame is None):
        elapsed = time_s - time_s[0] + float(own[0] / found)
        placed = _between(grid, row, elapsed, placed)
    return Placement(grid, placed, row), found


def first_number(frame: np.ndarray, first: int | None, time_s: np.ndarray | None) -> int:
    """Return the number of the film's first picture.

    Where it is not known it is 0, or 1 if that is the first row's; times that start at 0 with a
    frame 1 say that it is 1.
    """
    if first is None:
        return int(frame[0] == 1)
    if first == 0 and frame[0] == 1 and time_s is not None and len(frame) > 1:
        return int(time_s[0] < 0.5 * np.median(np.diff(time_s) / np.diff(frame)))
    return first


def _gaps(own: np.ndarray, pictures: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the frames that should have rows, every or every n-th, and their rows."""
    step = max(int(np.median(np.diff(own))), 1) if len(own) > 1 else 1
    grid = np.unique(np.concatenate([np.arange(own[0] % step, pictures, step), own]))
    row = np.full(len(grid), -1)
    row[np.searchsorted(grid, own)] = np.arange(len(own))
    return grid, row


def _between(
    grid: np.ndarray, row: np.ndarray, elapsed: np.ndarray, regular: np.ndarray
) -> np.ndarray:
    """Return the rows' own times, and for gaps times between them or before the first."""
    known = row >= 0
    times = np.interp(grid, grid[known], elapsed)
    before = grid < grid[known][0]
    times = np.where(before, regular, times)
    if (np.diff(times) <= 0).any():
        raise ValueError("its frame numbers and its times contradict each other")
    return times
