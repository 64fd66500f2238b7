"""`label_proposals.tsv`: the frames of a session that are most worth labelling, best first."""

from collections.abc import Sequence
from pathlib import Path

from stages.files import delimited

COLUMNS = ("rank", "shot", "frame", "time_s", "confidence", "residual", "reason")


def write(path: str | Path, rows: Sequence[Sequence[str]]) -> None:
    """Write rows of cells in the order of `COLUMNS`."""
    delimited.write(path, COLUMNS, rows)


def read(path: str | Path) -> list[dict[str, str]]:
    """Read the rows.

    Raises
    ------
    errors.InputError
        if the table has other columns
    """
    return [row.cells for row in delimited.read(path, COLUMNS)]
