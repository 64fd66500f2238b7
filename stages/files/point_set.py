"""Point sets: which contours a face is labelled with, and how many points stand for each.

A tab-separated table `contour, kind, count`. Kind is `closed`, `open` or `point`. The count is
the number of points after even resampling; blank keeps the labelled points as they are.
"""

import dataclasses
from pathlib import Path

from stages.files import delimited, errors

KINDS = ("closed", "open", "point")


@dataclasses.dataclass(frozen=True)
class Contour:
    """A contour of the face.

    Attributes
    ----------
    name : for example `lips_outer`
    kind : `closed`, `open` or `point`
    count : points after resampling; None keeps the labelled ones
    """

    name: str
    kind: str
    count: int | None


def read(path: str | Path) -> list[Contour]:
    """Read a point set, in the file's order.

    Raises
    ------
    errors.InputError
        naming line and cell
    """
    contours = []
    for row in delimited.read(path, ("contour", "kind", "count")):
        name, kind, count = (row.cells[column] for column in ("contour", "kind", "count"))
        if kind not in KINDS:
            message = f"line {row.line}, column kind: '{kind}' is none of {', '.join(KINDS)}"
            raise errors.InputError(path, message)
        if name in [contour.name for contour in contours]:
            raise errors.InputError(
                path, f"line {row.line}: contour {name} stands twice: remove one"
            )
        wanted = delimited.whole_number(path, row, "count") if count else None
        if wanted is not None and wanted < (1 if kind == "point" else 2):
            message = f"line {row.line}, column count: {wanted} points are too few for {kind}"
            raise errors.InputError(path, message)
        contours.append(Contour(name, kind, 1 if kind == "point" else wanted))
    return contours


def point_names(contour: Contour, count: int) -> list[str]:
    """Return the names of a contour's points: `lips_outer_00`, or just the name of a `point`."""
    if contour.kind == "point":
        return [contour.name]
    return [f"{contour.name}_{index:02d}" for index in range(count)]


def contour_of(point: str) -> str:
    """Return the contour that a point's name belongs to."""
    stem, _, index = point.rpartition("_")
    return stem if stem and index.isdecimal() else point
