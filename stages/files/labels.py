"""Labels: the contours that a person drew on some frames of a film.

A comma-separated table `frame,point,x_px,y_px` with an optional column `corner`; points are named
`<contour>_<NN>` in order along the contour. Pixels: x right, y down, the centre of the first pixel
is (0.5, 0.5). A `1` in `corner` marks the points between which a contour is resampled.
"""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import delimited, errors, point_set

COLUMNS = ("frame", "point", "x_px", "y_px")
OPTIONAL_COLUMNS = ("corner",)


@dataclasses.dataclass(frozen=True)
class Polyline:
    """A contour as labelled on one frame.

    Attributes
    ----------
    points : (N, 2) float array [px]
    corners : indices of the marked corners, ascending
    """

    points: np.ndarray
    corners: tuple[int, ...]


def read(path: str | Path, contours: Sequence[point_set.Contour]) -> dict[int, dict[str, Polyline]]:
    """Read the labelled frames of a shot: frame -> contour -> polyline.

    Raises
    ------
    errors.InputError
        naming line, frame and contour
    """
    known = {contour.name: contour for contour in contours}
    drawn: dict[int, dict[str, dict[int, tuple[float, float, bool]]]] = {}
    for row in delimited.read(path, COLUMNS, OPTIONAL_COLUMNS, separator=","):
        frame = delimited.whole_number(path, row, "frame")
        point = row.cells["point"]
        name = point if point in known else point_set.contour_of(point)
        if name not in known:
            message = f"line {row.line}: point {point} belongs to no contour of the point set"
            raise errors.InputError(path, message)
        index = 0 if point == name else int(point.rpartition("_")[2])
        places = drawn.setdefault(frame, {}).setdefault(name, {})
        if index in places:
            raise errors.InputError(
                path, f"line {row.line}: frame {frame} has {point} twice: remove one"
            )
        x, y = (delimited.number(path, row, column) for column in ("x_px", "y_px"))
        places[index] = (x, y, row.cells.get("corner", "") == "1")
    labelled = {
        frame: {name: _polyline(places) for name, places in sorted(found.items())}
        for frame, found in sorted(drawn.items())
    }
    for frame, found in labelled.items():
        _check_frame(path, frame, found, known)
    return labelled


def labelled_frames(path: str | Path) -> set[int]:
    """Return the numbers of the frames that have labels, whatever their contours.

    Raises
    ------
    errors.InputError
        if the table cannot be read
    """
    rows = delimited.read(path, COLUMNS, OPTIONAL_COLUMNS, separator=",")
    return {delimited.whole_number(path, row, "frame") for row in rows}


def _polyline(places: dict[int, tuple[float, float, bool]]) -> Polyline:
    """Return the points in the order of their numbers."""
    ordered = [places[index] for index in sorted(places)]
    corners = tuple(index for index, place in enumerate(ordered) if place[2])
    return Polyline(np.array([place[:2] for place in ordered]), corners)


def _check_frame(
    path: str | Path,
    frame: int,
    found: dict[str, Polyline],
    known: dict[str, point_set.Contour],
) -> None:
    """Refuse a frame on which a contour is missing or cannot be resampled."""
    for name, contour in known.items():
        if name not in found:
            message = f"frame {frame}: contour {name} is missing; label it or remove the frame"
            raise errors.InputError(path, message)
        if contour.kind == "closed" and contour.count and not found[name].corners:
            message = (
                f"frame {frame}: closed contour {name} has no corner; put a 1 in column corner"
            )
            raise errors.InputError(path, message)
        if contour.kind != "point" and len(found[name].points) < 2:
            message = f"frame {frame}: contour {name} has only one point: label the others"
            raise errors.InputError(path, message)
