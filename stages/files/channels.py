"""A character's table of channels: `shape, gain, offset, low, high, smoothing, keep`.

A row sets one shape of the rig, named `<mask>.<shape>` or `<shape>` for every mask that has it. All
columns but `shape` may be left out or blank: gain 1, offset 0, the limits of the method, smoothing
1, and keep as the shape's name suggests. `smoothing` is a factor, 0 leaves the channel as it is;
`keep` names the moments that smoothing must not touch: `blink` or `closure`.
"""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import delimited, errors

KEEP = ("blink", "closure")
DEFAULTS = {"gain": "1", "offset": "0", "low": "", "high": "", "smoothing": "1", "keep": ""}


@dataclasses.dataclass(frozen=True)
class Channels:
    """What the table asks of every shape of a rig.

    A weight u stays within low and high as it is solved, and `gain u + offset` as it is delivered.

    Attributes
    ----------
    names : the K shapes, `<mask>.<shape>`
    gain, offset : (K,) float arrays
    low, high : (K,) float arrays, limits of the weight; may be infinite
    strength : (K,) float array, factor of the smoothing, 0 or more
    keep : K times `blink`, `closure`, or nothing
    """

    names: list[str]
    gain: np.ndarray
    offset: np.ndarray
    low: np.ndarray
    high: np.ndarray
    strength: np.ndarray
    keep: list[str]


def read(path: str | Path, names: Sequence[str], low: float, high: float) -> Channels:
    """Read the table for a rig; an empty path asks nothing.

    Parameters
    ----------
    path : the table, or an empty text
    names : the K shapes of the rig, `<mask>.<shape>`
    low, high : the limits of shapes without limits of their own

    Raises
    ------
    errors.InputError
        naming line and column
    """
    rows = delimited.read(path, ("shape",), tuple(DEFAULTS)) if path else []
    made = Channels(
        list(names),
        np.ones(len(names)),
        np.zeros(len(names)),
        np.full(len(names), float(low)),
        np.full(len(names), float(high)),
        np.ones(len(names)),
        [""] * len(names),
    )
    line_of: dict[int, int] = {}
    for row in rows:
        cells = DEFAULTS | {name: cell for name, cell in row.cells.items() if cell}
        filled = delimited.Row(row.line, cells)
        for index in _shapes(path, row, names):
            if index in line_of:
                message = f"{names[index]} stands in line {line_of[index]} already, remove one"
                raise errors.InputError(path, f"line {row.line}, column shape: {message}")
            line_of[index] = row.line
            _set(path, filled, made, index)
    return made


def _shapes(path: str | Path, row: delimited.Row, names: Sequence[str]) -> list[int]:
    """Return the indices of the shapes that a row names."""
    wanted = row.cells["shape"]
    found = [i for i, name in enumerate(names) if wanted in (name, name.partition(".")[2])]
    if not found:
        message = f"the rig has no shape '{wanted}', its first is {names[0]}: rename it or drop it"
        raise errors.InputError(path, f"line {row.line}, column shape: {message}")
    return found


def _set(path: str | Path, row: delimited.Row, made: Channels, index: int) -> None:
    """Enter one row into the arrays being made."""
    for column, array in (("gain", made.gain), ("offset", made.offset)):
        array[index] = delimited.number(path, row, column)
    for column, array in (("low", made.low), ("high", made.high)):
        if row.cells[column]:
            array[index] = delimited.number(path, row, column)
    low, high = made.low[index], made.high[index]
    if low > high:
        column = "low" if row.cells["low"] else "high"
        message = f"low {low:g} is above high {high:g}: swap or change them"
        raise errors.InputError(path, f"line {row.line}, column {column}: {message}")
    made.strength[index] = delimited.number(path, row, "smoothing")
    if made.strength[index] < 0:
        message = f"'{row.cells['smoothing']}' is negative: give 0 or more"
        raise errors.InputError(path, f"line {row.line}, column smoothing: {message}")
    made.keep[index] = row.cells["keep"]
    if row.cells["keep"] not in ("", *KEEP):
        message = f"'{row.cells['keep']}' is none of {', '.join(KEEP)}: choose one or leave blank"
        raise errors.InputError(path, f"line {row.line}, column keep: {message}")
