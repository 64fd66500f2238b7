"""Faults of a marker take: tab-separated `marker, first_frame, last_frame, fault, cure`.

Faults: `gap`, the marker was not seen; `jump`, it leapt away and back; `swap`, it had exchanged
its label with another; `distance`, it was where no face reaches; `missing`, it is never seen.
Cures: `filled` from the other markers, `replaced` by an estimate or, after a swap, by its own
path, `left` without a place. Frames count from 0 and lie inside.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from stages.files import delimited

COLUMNS = ("marker", "first_frame", "last_frame", "fault", "cure")


class Fault(NamedTuple):
    """Hold a row of the table."""

    marker: str
    first_frame: int
    last_frame: int
    fault: str
    cure: str


def write(path: str | Path, faults: Iterable[Fault]) -> None:
    """Write the table."""
    delimited.write(path, COLUMNS, ([str(cell) for cell in fault] for fault in faults))


def read(path: str | Path) -> list[Fault]:
    """Read the table.

    Raises
    ------
    errors.InputError
        naming line and column
    """
    return [
        Fault(
            row.cells["marker"],
            delimited.whole_number(path, row, "first_frame"),
            delimited.whole_number(path, row, "last_frame"),
            row.cells["fault"],
            row.cells["cure"],
        )
        for row in delimited.read(path, COLUMNS)
    ]
