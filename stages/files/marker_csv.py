"""Marker takes in wide text tables: a row for each frame, three columns for each marker.

Columns are `<marker>_x`, `<marker>.x` or `<marker>:X`, in any order; `frame` and `time` (`time_s`,
`time_ms`) number the rows. The separator is the comma, semicolon or tab that the first line has
most of; without commas between cells, a comma is the decimal mark. Blank cells, NA, NaN and `-`
are gaps, and so are three zeros, but for a marker that lies in the origin throughout.
"""

import re
from pathlib import Path

import numpy as np

from stages.files import errors, marker_rows, marker_take

SEPARATORS = (",", ";", "\t")
COORDINATE = re.compile(r"(.+?)\s*[_.: ]\s*([xyz])", re.IGNORECASE)
FRAME = ("frame", "frame#", "frame_number", "field #")
TIME_S = {"time": 1.0, "time_s": 1.0, "time (s)": 1.0, "timestamp": 1.0, "time_ms": 1e-3}


def read(path: str | Path) -> marker_take.MarkerTake:
    """Read the markers of a wide table.

    Raises
    ------
    errors.InputError
        naming line and column of what cannot be read
    """
    separator = _separator(path)
    lines = marker_rows.lines_of(path, separator)
    header = next(cells for _, cells in lines if any(cells))
    markers, frame, time = _columns(path, header)
    marker_take.check_names(path, list(markers))
    wanted = [column for trio in markers.values() for column in trio]
    unit_s = TIME_S[header[time].lower()] if time is not None else 1.0
    decimal = "." if separator == "," else ","
    rows = marker_rows.read(path, lines, header, wanted, frame, time, unit_s, decimal)
    values, by_times = marker_rows.on_frames(path, rows)
    points = values.reshape(len(values), len(markers), 3)
    zero = ~points.any(axis=2)
    # a marker that others are measured from lies in the origin on every frame
    points[zero & ~zero.all(axis=0)] = np.nan
    rates = {"its times": by_times} if by_times is not None else {}
    left = [name for c, name in enumerate(header) if c not in (frame, time, *wanted) and name]
    notes = (f"left aside the columns {', '.join(left)}",) if left else ()
    return marker_take.MarkerTake(list(markers), points, "", rates, notes)


def _separator(path: str | Path) -> str:
    """Return the separator that the first line has most of."""
    for _, cells in marker_rows.lines_of(path, "\0"):
        if cells and cells[0]:
            return max(SEPARATORS, key=cells[0].count)
    raise errors.InputError(path, "is empty: export it again")


def _columns(
    path: str | Path, header: list[str]
) -> tuple[dict[str, tuple[int, int, int]], int | None, int | None]:
    """Return each marker's three columns, and those of frame and time."""
    found: dict[str, dict[str, int]] = {}
    frame = time = None
    for column, name in enumerate(header):
        if name.lower() in FRAME:
            frame = column if frame is None else frame
        elif name.lower() in TIME_S:
            time = column if time is None else time
        elif match := COORDINATE.fullmatch(name):
            marker, axis = match[1], match[2].lower()
            if axis in found.setdefault(marker, {}):
                message = f"two columns hold {axis} of marker '{marker}': rename one"
                raise errors.InputError(path, message)
            found[marker][axis] = column
    for marker, axes in found.items():
        if missing := [axis for axis in "xyz" if axis not in axes]:
            message = f"marker '{marker}' has no column {missing[0]}: add it, or rename the others"
            raise errors.InputError(path, message + " so that they end in no axis")
    if not found:
        message = "names no marker in its first line, such as chin_x, chin_y, chin_z"
        raise errors.InputError(path, message + ": is it of another kind?")
    return {marker: tuple(axes[a] for a in "xyz") for marker, axes in found.items()}, frame, time
