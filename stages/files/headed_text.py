"""Text tables of other programs: one line of column names, rows of numbers below.

Commas, semicolons or tabs between cells, whichever the first line has most of; without commas
between cells a comma is the decimal mark. Blanks round a name do not count.
"""

import csv
import dataclasses
import io
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from stages.files import errors, text_file

SEPARATORS = (",", ";", "\t")
FRAME = ("frame", "frame_number", "frame_index", "frame_id", "frame_num", "frameindex", "frame_idx")
TIME = re.compile(r"(?:time|timestamp|t)(?:[_ ]?\(?(us|ms|milliseconds|s|sec|seconds)\)?)?")
LARGEST = 1e15
UNIT_S = {"us": 1e-6, "ms": 1e-3, "milliseconds": 1e-3, "s": 1.0, "sec": 1.0, "seconds": 1.0}


@dataclasses.dataclass(frozen=True)
class Table:
    """A table whose rows are still to be read.

    Attributes
    ----------
    header : names of the columns, stripped
    lines : line number and stripped cells of each row
    decimal : the decimal mark
    """

    header: list[str]
    lines: Iterator[tuple[int, list[str]]]
    decimal: str


def read(path: str | Path) -> Table:
    """Read the header of a table.

    Raises
    ------
    errors.InputError
        if the file is no text, or two columns have one name
    """
    text = text_file.read(path).lstrip("\r\n")
    first = text.splitlines()[0]
    separator = max(SEPARATORS, key=first.count)
    lines = _lines(path, text, separator)
    _, header = next(lines)
    for name in header:
        if name and header.count(name) > 1:
            raise errors.InputError(path, f"column '{name}' stands twice: remove one")
    return Table(header, lines, "." if separator == "," else ",")


def _lines(path: str | Path, text: str, separator: str) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and cells."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator)
    try:
        for cells in reader:
            yield reader.line_num, [cell.strip() for cell in cells]
    except csv.Error as error:
        message = f"line {reader.line_num}: {error}: is a quotation mark missing?"
        raise errors.InputError(path, message) from error


def column(header: Sequence[str], names: Sequence[str]) -> int | None:
    """Return the first column that has one of the names, whatever its case; None if none has."""
    found = (index for index, name in enumerate(header) if name.lower() in names)
    return next(found, None)


def whole(path: str | Path, values: np.ndarray, places: Sequence[str]) -> np.ndarray:
    """Return frame numbers (T,) as whole ones; refuse others, naming the place."""
    wrong = np.flatnonzero((np.abs(values) >= LARGEST) | (values != np.rint(values)))
    if len(wrong):
        message = f"{places[wrong[0]]}: {values[wrong[0]]:g} is no number of a frame"
        raise errors.InputError(path, message + ": export it again")
    return values.astype(np.int64)


def time_unit(name: str) -> tuple[bool, float | None]:
    """Say whether a name is that of times, and their unit [s] if it says so."""
    found = TIME.fullmatch(re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower())
    return found is not None, UNIT_S.get(found[1]) if found else None


def time_column(header: Sequence[str]) -> tuple[int | None, float | None]:
    """Return the first column of times and its unit [s], None where it is not stated."""
    for index, name in enumerate(header):
        is_time, unit = time_unit(name)
        if is_time:
            return index, unit
    return None, None
