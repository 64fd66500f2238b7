"""Landmarks in wide text tables: a row a frame, two columns a point.

Columns are told by their names: `lips_outer_00.x` are keyface's own; `x_0`, `x0`, `0_x`,
`landmark_0_x` a tracker's, by index; of OpenFace the pixels `x_0` are read and not the millimetres
`X_0`, of py-feat the mesh `mesh_x_0` or, where there is none, the 68 points `x_0`. Blank cells are
gaps, and so are rows whose `success` is 0. OpenFace counts frames from 1 and, like OpenCV, puts the
centre of the first pixel at (0, 0).
"""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import frame_clock
from stages.files import errors, headed_text, landmark_take, marker_rows

NAMED = re.compile(r"(?!(?:landmark|lm|point|p)_?\d+\.)(.*\D.*)\.([xy])")
AXIS_FIRST = re.compile(r"(.*?)([xy])_?(\d+)")
INDEX_FIRST = re.compile(r"(.*?)(\d+)[_. ]?([xy])")
CONFIDENCE = ("confidence", "facescore")
SUCCESS = ("success",)
WIDTH, HEIGHT = ("framewidth", "width"), ("frameheight", "height")
OPENFACE_SHIFT = 0.5
Columns = dict[int | str, dict[str, int]]


def sets(header: Sequence[str]) -> dict[str, Columns]:
    """Return the sets of points that a header names: prefix -> point -> axis -> column.

    Named points have the prefix `.`.
    """
    found: dict[str, Columns] = {}
    for column, name in enumerate(header):
        if match := NAMED.fullmatch(name):
            prefix, point, axis = ".", match[1], match[2]
        elif match := AXIS_FIRST.fullmatch(name):
            prefix, point, axis = match[1], int(match[3]), match[2]
        elif match := INDEX_FIRST.fullmatch(name):
            prefix, point, axis = match[1], int(match[2]), match[3]
        else:
            continue
        found.setdefault(prefix, {}).setdefault(point, {})[axis] = column
    return {prefix: points for prefix, points in found.items() if _whole(points)}


def check_names(path: str | Path, names: Sequence[str]) -> None:
    """Refuse named points whose names would break the names of columns."""
    for name in names:
        if any(letter in name for letter in ".:/\\"):
            message = f"'{name}' is no name of a point: rename it without dots, colons and slashes"
            raise errors.InputError(path, message)


def _whole(points: Columns) -> bool:
    """Say whether points have both axes, and indices that count from 0."""
    if any(len(axes) < 2 for axes in points.values()):
        return False
    return isinstance(next(iter(points)), str) or sorted(points) == list(range(len(points)))


def read(path: str | Path, table: headed_text.Table) -> landmark_take.LandmarkTake:
    """Read a take.

    Raises
    ------
    errors.InputError
        naming line and column
    """
    header = table.header
    found = sets(header)
    if "." in found:
        found = {".": found["."]}
        check_names(path, [str(point) for point in found["."]])
    elif any(len(points) in landmark_take.TRACKERS for points in found.values()):
        # the larger set of a tracker that has two comes first
        keep = (item for item in found.items() if len(item[1]) in landmark_take.TRACKERS)
        found = dict(sorted(keep, key=lambda item: -len(item[1])))
    else:
        largest = max(len(points) for points in found.values())
        landmark_take.tracker_of(path, largest)
    others = {
        name: headed_text.column(header, names)
        for name, names in (
            ("confidence", CONFIDENCE),
            ("success", SUCCESS),
            ("width", WIDTH),
            ("height", HEIGHT),
        )
    }
    chosen = [
        points[point][axis]
        for points in found.values()
        for point in (points if "." in found else sorted(points))
        for axis in "xy"
    ]
    extra = {name: column for name, column in others.items() if column is not None}
    frame = headed_text.column(header, headed_text.FRAME)
    time, unit_s = headed_text.time_column(header)
    wanted = [*chosen, *extra.values()]
    rows = marker_rows.read(
        path, table.lines, header, wanted, frame, time, unit_s or 1.0, table.decimal
    )
    values = rows.values.astype(np.float64)
    beside = dict(zip(extra, values[:, len(chosen) :].T, strict=True))
    return _take(path, rows, found, values[:, : len(chosen)], beside, unit_s)


def _take(
    path: str | Path,
    rows: marker_rows.Rows,
    found: dict[str, Columns],
    values: np.ndarray,
    beside: dict[str, np.ndarray],
    unit_s: float | None,
) -> landmark_take.LandmarkTake:
    """Put the columns together."""
    lost = beside["success"] == 0 if "success" in beside else np.zeros(len(values), bool)
    choices, start = {}, 0
    for prefix, points in found.items():
        block = values[:, start : start + 2 * len(points)].reshape(len(values), -1, 2)
        start += 2 * len(points)
        tracker = "" if prefix == "." else landmark_take.TRACKERS[len(points)]
        block = np.where(lost[:, None, None], np.nan, block)
        if np.isfinite(block).all(axis=2).any():
            choices[tracker] = block
    if not choices:
        message = f"a face was found on none of its {len(values)} frames: track the film again"
        raise errors.InputError(path, message)
    seen = np.isfinite(next(iter(choices.values()))).all(axis=2).any(axis=1)
    confidence = np.clip(np.nan_to_num(beside.get("confidence", np.ones(len(values)))), 0, 1)
    openface = "success" in beside
    return landmark_take.LandmarkTake(
        choices,
        list(found.get(".", {})),
        np.where(seen, confidence, 0.0),
        frame=_frames(path, rows),
        first=1 if openface else 0,
        time_s=_times(path, rows, unit_s),
        size=_size(beside),
        shift=OPENFACE_SHIFT if openface else 0.0,
    )


def _frames(path: str | Path, rows: marker_rows.Rows) -> np.ndarray | None:
    """Return the frames' numbers, if there is a column of them."""
    if not len(rows.frame):
        return None
    places = [f"line {line}" for line in rows.lines]
    numbers = headed_text.whole(path, rows.frame, places)
    landmark_take.check_frames(path, numbers, places)
    return numbers


def _times(path: str | Path, rows: marker_rows.Rows, unit_s: float | None) -> np.ndarray | None:
    """Return the frames' times [s], if there is a column of them."""
    if not len(rows.time_s):
        return None
    if (wrong := np.flatnonzero(np.diff(rows.time_s) <= 0)).size:
        message = f"line {rows.lines[wrong[0] + 1]}: its time does not follow the one before"
        raise errors.InputError(path, message + ": sort the rows, keep one face a frame")
    return rows.time_s if unit_s else frame_clock.seconds(rows.time_s)


def _size(beside: dict[str, np.ndarray]) -> tuple[float, float] | None:
    """Return the size of the picture, if there are columns of it."""
    if "width" not in beside or "height" not in beside:
        return None
    known = np.isfinite(beside["width"]) & np.isfinite(beside["height"])
    if not known.any():
        return None
    return float(beside["width"][known][0]), float(beside["height"][known][0])
