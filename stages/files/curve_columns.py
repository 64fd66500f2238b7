"""Curves in wide text tables: a row a frame, a column a channel in any known spelling.

Columns `frame` and `time` (`timestamp_ms`, ...) number the rows; py-feat's and MediaPipe's tables
are of this kind.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import frame_clock
from stages.files import curve_take, errors, headed_text, marker_rows, shape_names

FEWEST = 3  # channels by which a table of curves is told


def channels(header: Sequence[str], table: Sequence[shape_names.Shape]) -> list[int]:
    """Return the columns that have a canonical name; none where they are too few."""
    found = [
        index for index, name in enumerate(header) if name and shape_names.names_of(table, name)
    ]
    return found if len(found) >= FEWEST else []


def read(
    path: str | Path, sheet: headed_text.Table, table: Sequence[shape_names.Shape]
) -> curve_take.CurveTake:
    """Read a take.

    Raises
    ------
    errors.InputError
        naming line and column
    """
    header = sheet.header
    wanted = channels(header, table)
    frame = headed_text.column(header, headed_text.FRAME)
    time, unit_s = headed_text.time_column(header)
    rows = marker_rows.read(
        path, sheet.lines, header, wanted, frame, time, unit_s or 1.0, sheet.decimal
    )
    places = [f"line {line}" for line in rows.lines]
    numbers = headed_text.whole(path, rows.frame, places) if len(rows.frame) else None
    times = rows.time_s if len(rows.time_s) else None
    for what, keys in (("frame", numbers), ("time", times)):
        if keys is not None and (wrong := np.flatnonzero(np.diff(keys) <= 0)).size:
            message = f"{places[wrong[0] + 1]}: its {what} does not follow the one before"
            raise errors.InputError(path, message + ": keep one face a frame, sort the rows")
    if times is not None and unit_s is None:
        times = frame_clock.seconds(times)
    names = [header[column] for column in wanted]
    curves, _ = curve_take.gather(table, names, rows.values.astype(np.float64))
    return curve_take.CurveTake(curves, [], times, numbers)
