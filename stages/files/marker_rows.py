"""Rows of numbers as tables of markers hold them, put on the frames that they stand for."""

import csv
import dataclasses
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from stages.files import errors

GAPS = frozenset(("", "na", "nan", "n/a", "null", "none", "-", "--"))
LARGEST = 1e30  # what float32 holds, with room for units
LONGEST = 40  # letters of a cell that are shown
SHORTEST_S = 1e-6
TIME_SLACK = 0.25  # of a frame's length, of a single row


@dataclasses.dataclass(frozen=True)
class Rows:
    """The numbers of a table.

    Attributes
    ----------
    values : (N, C) float32 array of the wanted columns, NaN where there is no number
    frame : (N,) float array; empty if no column numbers the frames
    time_s : (N,) float array [s]; empty if no column holds times
    lines : the N rows' line numbers
    """

    values: np.ndarray
    frame: np.ndarray
    time_s: np.ndarray
    lines: list[int]


def lines_of(path: str | Path, separator: str) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and stripped cells of every line of a text table.

    Raises
    ------
    errors.InputError
        if the file is no UTF-8 text
    """
    with Path(path).open(encoding="utf-8-sig", newline="") as stream:
        reader = csv.reader(stream, delimiter=separator)
        try:
            for cells in reader:
                yield reader.line_num, [cell.strip() for cell in cells]
        except (UnicodeDecodeError, csv.Error) as error:
            message = f"is no table of UTF-8 text after line {reader.line_num}: export it as text"
            raise errors.InputError(path, message) from error


def read(
    path: str | Path,
    lines: Iterator[tuple[int, list[str]]],
    header: Sequence[str],
    wanted: Sequence[int],
    frame: int | None,
    time: int | None,
    time_unit_s: float = 1.0,
    decimal: str = ".",
) -> Rows:
    """Read the numbers below a header.

    Parameters
    ----------
    path : the file, for errors
    lines : what `lines_of` yields below the header
    header : names of the columns, for errors
    wanted : columns of coordinates
    frame, time : columns of frame numbers and times; None if there is none
    time_unit_s : what one of the time column is [s]
    decimal : the decimal mark

    Raises
    ------
    errors.InputError
        naming line and column of what is no number, or the line that is cut short
    """
    keys = [column for column in (frame, time) if column is not None]
    values, places, numbers = [], [], []
    for number, cells in lines:
        if not any(cells):
            continue
        if len(cells) < len(header) or any(cells[len(header) :]):
            message = f"line {number} has {len(cells)} cells, the header has {len(header)}"
            raise errors.InputError(path, message + ": is it cut short? export it again")
        row = _numbers(path, number, cells, header, [*keys, *wanted], decimal)
        if not np.isfinite(row[: len(keys)]).all():
            message = f"line {number} lacks its {header[keys[0]]}: export it again"
            raise errors.InputError(path, message)
        places.append(row[: len(keys)])
        values.append(np.array(row[len(keys) :], np.float32))
        numbers.append(number)
    if not values:
        raise errors.InputError(path, "holds no row of numbers: is it cut short? export it again")
    by_key = dict(zip(keys, np.array(places, float).reshape(len(values), -1).T, strict=True))
    none = np.zeros(0)
    return Rows(
        np.stack(values),
        by_key.get(frame, none),
        by_key[time] * time_unit_s if time is not None else none,
        numbers,
    )


def _numbers(
    path: str | Path,
    line: int,
    cells: list[str],
    header: Sequence[str],
    columns: Sequence[int],
    decimal: str,
) -> list[float]:
    """Return the numbers of a row's columns."""
    row = []
    for column in columns:
        text = cells[column] if decimal == "." else cells[column].replace(decimal, ".")
        try:
            value = float(text)
        except ValueError:
            value = np.nan if text.lower() in GAPS else np.inf
        if abs(value) > LARGEST:
            # a quotation mark that is never closed holds the rest of the file
            shown = cells[column][:LONGEST]
            message = f"line {line}, column {header[column]}: '{shown}' is no number"
            raise errors.InputError(path, message + ": leave it blank for a gap")
        row.append(value)
    return row


def on_frames(path: str | Path, rows: Rows) -> tuple[np.ndarray, float | None]:
    """Put rows on consecutive frames, with empty ones where the file leaves frames out.

    Parameters
    ----------
    path : the file, for errors
    rows : what `read` gives

    Returns
    -------
    values : (T, C) float32 array
    rate : frames per second by the times; None if there are none

    Raises
    ------
    errors.InputError
        if frame numbers or times do not rise, or are no multiples of a frame
    """
    index = np.arange(len(rows.values))
    if len(rows.frame):
        index = np.rint(rows.frame - rows.frame[0]).astype(np.int64)
    elif len(rows.time_s) > 1:
        # step by step, as the median of rounded times is off by some percent
        steps = np.diff(rows.time_s)
        usual = max(float(np.median(steps)), SHORTEST_S)
        index = np.concatenate([[0], np.cumsum(np.rint(steps / usual))]).astype(np.int64)
    _check_rising(path, rows, index, "frame number" if len(rows.frame) else "time")
    by_times = None
    if len(rows.time_s) > 1:
        by_times = _rate_of_times(path, rows, index)
    if index[-1] >= 2 * len(index) + 1000:
        message = f"{len(index)} rows stand for {index[-1] + 1} frames: export it again, whole"
        raise errors.InputError(path, message)
    values = np.full((index[-1] + 1, rows.values.shape[1]), np.nan, np.float32)
    values[index] = rows.values
    return values, by_times


def _check_rising(path: str | Path, rows: Rows, index: np.ndarray, what: str) -> None:
    """Refuse rows whose frames do not follow each other."""
    if (wrong := np.flatnonzero(np.diff(index) < 1)).size:
        message = f"line {rows.lines[wrong[0] + 1]}: its {what} does not follow the one before"
        raise errors.InputError(path, message + ": sort the rows, or export it again")


def _rate_of_times(path: str | Path, rows: Rows, index: np.ndarray) -> float:
    """Return frames per second, if every row lies on its frame."""
    elapsed = rows.time_s - rows.time_s[0]
    if not elapsed[-1] > 0:
        raise errors.InputError(path, "its times do not rise: export it again")
    rate = index[-1] / elapsed[-1]
    if (wrong := np.flatnonzero(np.abs(elapsed * rate - index) > TIME_SLACK)).size:
        line, time_s = rows.lines[wrong[0]], rows.time_s[wrong[0]]
        message = f"line {line}: its time {time_s:g} s lies between the frames of a constant rate"
        raise errors.InputError(path, message + f" of {rate:.6g} Hz: export it with a constant one")
    return float(rate)
