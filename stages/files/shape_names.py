"""Names of facial shapes: ARKit's 52 and how other packages spell them.

A tab-separated table `name, side, low, high, kind, mirror` and a column for each spelling. The rows
stand in the order of Live Link Face. A cell holds the shape's name in that package; several with
commas between them where the package splits the shape, nothing where it has none, or none that is
known. Packages may share a shape between rows (one `lookUp` for both eyes).
"""

import dataclasses
from collections.abc import Collection, Sequence
from pathlib import Path

from stages.files import delimited, errors

SPELLINGS = ("arkit", "mediapipe", "ict", "vrm", "livelink", "unreal")
COLUMNS = ("name", "side", "low", "high", "kind", "mirror", *SPELLINGS)
SIDES = ("left", "right", "middle")
CORRECTIVE = "corrective_of:"


@dataclasses.dataclass(frozen=True)
class Shape:
    """A shape of the canonical set.

    Attributes
    ----------
    name : as ARKit spells it
    side : `left`, `right` (the subject's own) or `middle`
    low, high : range of its weight
    kind : `delta` (added to the neutral), `corrective_of:<name>` (means something only together
        with that shape), `full` (an expression of the whole face)
    mirror : the shape of the other side; itself in the middle
    spellings : package -> its names for the shape
    """

    name: str
    side: str
    low: float
    high: float
    kind: str
    mirror: str
    spellings: dict[str, tuple[str, ...]]


def read(path: str | Path) -> list[Shape]:
    """Read the table.

    Raises
    ------
    errors.InputError
        naming line and column
    """
    rows = delimited.read(path, COLUMNS)
    names = [row.cells["name"] for row in rows]
    return [_shape(path, row, names) for row in rows]


def _shape(path: str | Path, row: delimited.Row, names: Sequence[str]) -> Shape:
    """Return one row, checked against the names of all."""
    cells = row.cells
    of = cells["kind"].removeprefix(CORRECTIVE)
    corrects = cells["kind"].startswith(CORRECTIVE) and of in names
    faults = {
        "name": not cells["name"] or names.count(cells["name"]) > 1,
        "side": cells["side"] not in SIDES,
        "kind": cells["kind"] not in ("delta", "full") and not corrects,
        "mirror": cells["mirror"] not in names,
    }
    for column, wrong in faults.items():
        if wrong:
            message = f"line {row.line}, column {column}: '{cells[column]}' is unknown or stands"
            raise errors.InputError(path, message + " twice: correct it")
    low, high = (delimited.number(path, row, column) for column in ("low", "high"))
    if low >= high:
        raise errors.InputError(path, f"line {row.line}: low {low:g} is not below high {high:g}")
    spellings = {package: _parts(cells[package]) for package in SPELLINGS}
    return Shape(cells["name"], cells["side"], low, high, cells["kind"], cells["mirror"], spellings)


def _parts(cell: str) -> tuple[str, ...]:
    """Return the names of a cell."""
    return tuple(part.strip() for part in cell.split(",") if part.strip())


def _plain(spelling: str) -> str:
    """Return a spelling without case and marks, which exporters change at will."""
    return "".join(letter for letter in spelling.casefold() if letter.isalnum())


def names_of(table: Sequence[Shape], spelling: str) -> list[str]:
    """Return the canonical names that a spelling stands for, in the table's order.

    Case and marks between words do not count. Most have one; a shape that two rows share has two.
    """
    wanted = _plain(spelling)
    return [
        shape.name
        for shape in table
        if wanted in {_plain(part) for parts in shape.spellings.values() for part in parts}
    ]


def spelt(shape: Shape, available: Collection[str]) -> list[str]:
    """Return the shapes of a rig that stand for a canonical one: several where it is split.

    Parameters
    ----------
    shape : the canonical shape
    available : the rig's names, in any spelling

    Returns
    -------
    the names as the rig spells them, of the one package of which it has most; empty if none
    """
    known = {_plain(name): name for name in available}
    choices = [
        [known[_plain(part)] for part in parts if _plain(part) in known]
        for parts in shape.spellings.values()
    ]
    return max(choices, key=len, default=[])
