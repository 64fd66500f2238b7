"""Tab- or comma-separated tables that people write, with the row and column of every fault."""

import csv
import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path

from stages.files import atomic, errors


@dataclasses.dataclass(frozen=True)
class Row:
    """A row of a table and where it stands.

    Attributes
    ----------
    line : line number in the file, counted from 1
    cells : column -> text, stripped
    """

    line: int
    cells: dict[str, str]


def read(
    path: str | Path, required: Sequence[str], optional: Sequence[str] = (), separator: str = "\t"
) -> list[Row]:
    """Read a table whose first row names the columns.

    Raises
    ------
    errors.InputError
        if the file is missing, no UTF-8 text, lacks a column, has an unknown or a doubled one,
        a quotation mark is not closed, or a row has another number of cells
    """
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise errors.InputError(
            path, "no such table: create it, with its header at least"
        ) from None
    except UnicodeDecodeError as error:
        message = f"is no UTF-8 text at byte {error.start}: save it as UTF-8"
        raise errors.InputError(path, message) from error
    lines = _lines(path, text, separator)
    if not lines:
        raise errors.InputError(path, f"is empty: its header is {', '.join(required)}")
    header = [name.strip() for name in lines[0]]
    _check_header(path, header, required, optional, separator)
    rows = []
    for number, line in enumerate(lines[1:], start=2):
        if not any(cell.strip() for cell in line):
            continue
        if len(line) != len(header):
            message = f"line {number} has {len(line)} cells, the header has {len(header)}"
            raise errors.InputError(path, message + ": add or remove separators")
        rows.append(Row(number, dict(zip(header, (cell.strip() for cell in line), strict=True))))
    return rows


def _lines(path: str | Path, text: str, separator: str) -> list[list[str]]:
    """Return the cells of every line."""
    reader = csv.reader(text.splitlines(), delimiter=separator)
    lines = []
    try:
        for cells in reader:
            lines.append(cells)
            if reader.line_num > len(lines):
                message = f"line {len(lines)}: a quotation mark is not closed on its line"
                raise errors.InputError(path, message + ": close or remove it")
    except csv.Error as error:
        message = f"line {len(lines) + 1}: {error}: remove quotation marks, or split the cell"
        raise errors.InputError(path, message) from error
    return lines


def _check_header(
    path: str | Path,
    header: list[str],
    required: Sequence[str],
    optional: Sequence[str],
    separator: str,
) -> None:
    """Compare the columns with those that the table may have."""
    known = [*required, *optional]
    between = "tabs" if separator == "\t" else "commas"
    for name in header:
        if name not in known:
            message = f"unknown column '{name}': the columns are {', '.join(known)}"
            raise errors.InputError(path, f"{message}, with {between} between them")
        if header.count(name) > 1:
            raise errors.InputError(path, f"column '{name}' stands twice: remove one")
    for name in required:
        if name not in header:
            raise errors.InputError(path, f"column '{name}' is missing: add it to the header")


def write(path: str | Path, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Write a tab-separated table whose first row names the columns."""
    with atomic.replacing(path) as temporary:
        temporary.write_text(as_text(columns, rows), encoding="utf-8")


def as_text(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return the text of a tab-separated table."""
    return "".join("\t".join(cells) + "\n" for cells in (columns, *rows))


def number(path: str | Path, row: Row, column: str) -> float:
    """Return a cell as a finite number, or name its place."""
    try:
        value = float(row.cells[column])
    except ValueError:
        value = float("nan")
    if not abs(value) < float("inf"):
        message = (
            f"line {row.line}, column {column}: '{row.cells[column]}' is not a number: write one"
        )
        raise errors.InputError(path, message)
    return value


def whole_number(path: str | Path, row: Row, column: str) -> int:
    """Return a cell as a whole number from 0, or name its place."""
    text = row.cells[column]
    if not text.isdecimal():
        message = f"line {row.line}, column {column}: '{text}' is not a whole number: write one"
        raise errors.InputError(path, message)
    return int(text)
