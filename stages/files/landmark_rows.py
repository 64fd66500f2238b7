"""Landmarks in long text tables: a row for each point of each frame.

Columns `frame` or a time, `index` (or `landmark`, `point`, `id`), `x`, `y`.
"""

import contextlib
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import frame_clock
from stages.files import errors, headed_text, landmark_take, marker_rows

INDEX = ("index", "landmark", "landmark_index", "landmark_id", "landmarkindex", "point", "id")


def is_long(header: Sequence[str]) -> bool:
    """Say whether a header is that of a long table of landmarks."""
    return all(headed_text.column(header, names) is not None for names in (INDEX, ("x",), ("y",)))


def read(path: str | Path, table: headed_text.Table) -> landmark_take.LandmarkTake:
    """Read a take.

    Raises
    ------
    errors.InputError
        naming the line
    """
    header = table.header
    time, unit_s = headed_text.time_column(header)
    columns = [
        headed_text.column(header, headed_text.FRAME),
        time,
        *(headed_text.column(header, names) for names in (INDEX, ("x",), ("y",))),
    ]
    if columns[0] is None and time is None:
        raise errors.InputError(path, "has no column of frames or times: add one named frame")
    keys, faces, lines = _frames(path, table, columns)
    if not keys:
        raise errors.InputError(path, "holds no row of numbers: is it cut short? export it again")
    points = _stacked(path, faces, lines)
    frames, times = (np.array(part) for part in zip(*keys, strict=True))
    number = None
    if columns[0] is not None:
        number = headed_text.whole(path, frames, lines)
        landmark_take.check_frames(path, number, lines)
    elif (np.diff(times) <= 0).any():
        raise errors.InputError(path, "its times do not rise: sort the rows")
    if time is None or (np.diff(times) <= 0).any():
        times = None
    else:
        times = times * unit_s if unit_s else frame_clock.seconds(times)
    seen = np.isfinite(points).all(axis=2).any(axis=1).astype(float)
    tracker = landmark_take.tracker_of(path, points.shape[1])
    return landmark_take.LandmarkTake({tracker: points}, [], seen, frame=number, time_s=times)


def _frames(
    path: str | Path, table: headed_text.Table, columns: Sequence[int | None]
) -> tuple[list[tuple[float, float]], list[np.ndarray], list[str]]:
    """Return frame and time, points (P, 3), and first line of every frame."""
    keys, faces, lines = [], [], []
    face: dict[float, tuple[float, float]] = {}
    for number, cells in table.lines:
        if not any(cells):
            continue
        frame, time_s, index, x, y = _numbers(path, number, cells, table, columns)
        if not keys or keys[-1] != (frame, time_s):
            if keys:
                faces.append(_packed(face))
            keys.append((frame, time_s))
            lines.append(f"line {number}")
            face = {}
        if index in face:
            message = f"line {number}: point {index:g} stands twice in its frame: keep one face"
            raise errors.InputError(path, message)
        face[index] = (x, y)
    return keys, [*faces, _packed(face)], lines


def _numbers(
    path: str | Path,
    line: int,
    cells: Sequence[str],
    table: headed_text.Table,
    columns: Sequence[int | None],
) -> list[float]:
    """Return frame, time, index, x and y of a row; 0 for a column that there is not."""
    if len(cells) < len(table.header):
        message = f"line {line} has {len(cells)} cells, the header has {len(table.header)}"
        raise errors.InputError(path, message + ": is it cut short? export it again")
    if table.decimal == ".":
        with contextlib.suppress(ValueError):
            numbers = [0.0 if column is None else float(cells[column]) for column in columns]
            if all(map(math.isfinite, numbers)):
                return numbers
    numbers = []
    for place, column in enumerate(columns):
        text = "0" if column is None else cells[column].replace(table.decimal, ".")
        try:
            value = float(text)
        except ValueError:
            value = math.nan if place > 2 and text.lower() in marker_rows.GAPS else math.inf
        if math.isinf(value) or (math.isnan(value) and place <= 2):
            message = f"line {line}, column {table.header[column]}: '{text}' is no number"
            raise errors.InputError(path, message + ": export it again")
        numbers.append(value)
    return numbers


def _packed(face: dict[float, tuple[float, float]]) -> np.ndarray:
    """Return index, x and y (P, 3) of a frame's points by their index: a tenth of the memory."""
    return np.array([(index, *place) for index, place in sorted(face.items())])


def _stacked(path: str | Path, faces: Sequence[np.ndarray], lines: Sequence[str]) -> np.ndarray:
    """Return the points (T, P, 2) of all frames, NaN where a frame has none."""
    count = max(len(face) for face in faces)
    points = np.full((len(faces), count, 2), np.nan)
    for row, face in enumerate(faces):
        if len(face) == 1 and np.isnan(face[0, 1:]).all():
            continue
        if not np.array_equal(face[:, 0], np.arange(count)):
            message = f"{lines[row]}: its frame has {len(face)} points of {count}"
            raise errors.InputError(path, message + ": is it cut short? export all points")
        points[row] = face[:, 1:]
    return points
