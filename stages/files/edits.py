"""An animator's edited curves of a take: `edits/<shot>/<animator>.tsv` or `.csv`.

Columns are `frame`, at the character's rate, and any curves of `weights.csv`: shapes by their full
or plain names, and the head's. A blank cell leaves the solved value as it is, so a table holds only
the stretches and channels that were changed; the columns `time_s` and `confidence` are ignored,
so that a copy of `weights.csv` will do.
"""

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from stages.files import delimited, errors

SEPARATORS = {".tsv": "\t", ".csv": ","}
IGNORED = ("time_s", "confidence")


def lay_over(
    path: str | Path, frames: np.ndarray, columns: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """Return curves with the cells of a table in place of the solved values.

    Parameters
    ----------
    path : the table
    frames : (T,) int array, the frames of the take
    columns : name -> (T,) float array; not changed

    Raises
    ------
    errors.InputError
        naming line and column of a curve or frame that the take does not have, of a frame that
        stands twice, and of a cell that is no number
    """
    separator = SEPARATORS.get(Path(path).suffix.lower())
    if separator is None:
        raise errors.InputError(path, "edits are .tsv or .csv files: rename it")
    edited = {name: values.copy() for name, values in columns.items()}
    owner = _owners(path, _header(path, separator), list(columns))
    row_of = {int(frame): row for row, frame in enumerate(frames)}
    line_of: dict[int, int] = {}
    for line in delimited.read(path, ("frame",), [*owner, *IGNORED], separator):
        frame = delimited.whole_number(path, line, "frame")
        if frame not in row_of:
            known = f"the take has {frames[0]} to {frames[-1]}"
            message = f"line {line.line}, column frame: there is no frame {frame}, {known}"
            raise errors.InputError(path, message + ": frames count at the character's rate")
        if frame in line_of:
            message = f"line {line.line}: frame {frame} stands in line {line_of[frame]} already"
            raise errors.InputError(path, message + ", remove one")
        line_of[frame] = line.line
        for column, name in owner.items():
            if line.cells[column]:
                edited[name][row_of[frame]] = delimited.number(path, line, column)
    return edited


def _header(path: str | Path, separator: str) -> list[str]:
    """Return the curves that a table names."""
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as stream:
            header = next(csv.reader(stream, delimiter=separator), [])
    except (FileNotFoundError, UnicodeDecodeError):
        return []  # the reader of the rows says so
    names = [name.strip() for name in header]
    return [name for name in dict.fromkeys(names) if name not in ("frame", *IGNORED)]


def _owners(path: str | Path, header: Sequence[str], known: Sequence[str]) -> dict[str, str]:
    """Return the curve that each column of a table stands for."""
    owner: dict[str, str] = {}
    for column in header:
        found = [name for name in known if column in (name, name.partition(".")[2])]
        if len(found) != 1:
            what = "names several curves" if found else "is no curve of the take"
            message = f"line 1: '{column}' {what}: use a name of weights.csv"
            raise errors.InputError(path, message)
        if found[0] in owner.values():
            raise errors.InputError(path, f"line 1: {found[0]} stands twice: remove one")
        owner[column] = found[0]
    return owner
