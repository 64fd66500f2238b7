"""Marker takes in C3D files.

Blocks of 512 bytes: a header, parameters, then for each frame x, y, z and a word of residual and
cameras for each point, followed by the analog samples; as float32, or as int16 times a scale. A
point is missing where its residual is negative, it is no number, or it lies exactly in the origin.

The counts of the header wrap at 65,535 frames: longer takes state theirs as POINT:LONG_FRAMES or
TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD. What is not all there is refused before it is read,
and points are read in parts, straight into one array.
"""

import dataclasses
from pathlib import Path
from typing import BinaryIO

import numpy as np

from stages.files import c3d_parameters, errors, marker_take

BLOCK = 512
MAGIC = 0x50
INTEL = 84
COUNTER_END = 0xFFFF
PART = 4096  # frames


@dataclasses.dataclass(frozen=True)
class Layout:
    """Where the points lie in a file.

    Attributes
    ----------
    start : first byte of the first frame
    words : numbers a frame, those of the analog samples included
    points : number of points
    scale : what whole numbers are multiplied by; negative if numbers are float32
    """

    start: int
    words: int
    points: int
    scale: float

    @property
    def kind(self) -> np.dtype:
        """Return the type of a number."""
        return np.dtype("<f4" if self.scale < 0 else "<i2")

    @property
    def frame_bytes(self) -> int:
        """Return the size of a frame."""
        return self.words * self.kind.itemsize


def read(path: str | Path) -> marker_take.MarkerTake:
    """Read the markers of a C3D file.

    Raises
    ------
    errors.InputError
        if the file is of another kind, damaged, or cut short
    """
    size = Path(path).stat().st_size
    with Path(path).open("rb") as stream:
        header = np.frombuffer(stream.read(BLOCK), np.uint8)
        if len(header) < BLOCK or header[1] != MAGIC or not header[0]:
            raise errors.InputError(path, "is no C3D file, or is cut short: export it again")
        section = (int(header[0]) - 1) * BLOCK
        stream.seek(section)
        start = stream.read(4)
        if len(start) == 4 and start[3] in (INTEL + 1, INTEL + 2):
            message = "holds the numbers of a DEC or SGI computer: save it in the PC (Intel) form"
            raise errors.InputError(path, message)
        blocks = start[2] if len(start) == 4 else 0
        stated = c3d_parameters.read(path, stream.read(max(blocks * BLOCK - 4, 0)))
        if not blocks or size < section + blocks * BLOCK or "POINT:LABELS" not in stated:
            message = "holds no labelled points, or is cut short: export it again"
            raise errors.InputError(path, message)
        layout = _layout(path, header, stated)
        held = max(size - layout.start, 0) // layout.frame_bytes
        count, certain = _frame_count(stated, header, held)
        if count < 1 or held < count:
            message = f"is cut short: {held} of {count} promised frames; copy or export it again"
            raise errors.InputError(path, message)
        stream.seek(layout.start)
        points = _points(stream, layout, count)
    if not certain:
        points = _without_padding(points)
    rates = {"POINT:RATE": _first(stated, "POINT:RATE"), "its header": _float(header, 10)}
    names = _labels(stated, layout.points)
    marker_take.check_names(path, names)
    unit = str((stated.get("POINT:UNITS") or [""])[0])
    usable = {place: rate for place, rate in rates.items() if np.isfinite(rate) and rate > 0}
    return marker_take.MarkerTake(names, points, unit, usable)


def _layout(path: str | Path, header: np.ndarray, stated: dict[str, list]) -> Layout:
    """Return where the points lie, header and parameters compared."""
    points, analog, start = (_word(header, place) for place in (1, 2, 8))
    used = int(_first(stated, "POINT:USED", points))
    if used != points:
        message = f"its header says {points} points, POINT:USED {used}: export it again"
        raise errors.InputError(path, message)
    start = int(_first(stated, "POINT:DATA_START", start)) or start
    scale = float(_first(stated, "POINT:SCALE", _float(header, 6)))
    if points == 0 or start < 2 or not np.isfinite(scale) or scale == 0:
        raise errors.InputError(path, "holds no points: export it again, with labelled markers")
    return Layout((start - 1) * BLOCK, 4 * points + analog, points, scale)


def _frame_count(stated: dict[str, list], header: np.ndarray, held: int) -> tuple[int, bool]:
    """Return the number of frames that the file promises, and whether it does."""
    count = int(_first(stated, "POINT:FRAMES", _word(header, 4) - _word(header, 3) + 1))
    if (count_long := int(_first(stated, "POINT:LONG_FRAMES", 0))) > COUNTER_END:
        return count_long, True
    fields = [stated.get(f"TRIAL:ACTUAL_{end}_FIELD", []) for end in ("START", "END")]
    if all(len(field) == 2 for field in fields):
        first, last = (int(low) + (int(high) << 16) for low, high in fields)
        actual = last - first + 1
        if actual > COUNTER_END and count in (COUNTER_END, actual & COUNTER_END):
            return actual, True
    if count == COUNTER_END:
        # some writers state no more than that the counter ran over: what is there is the take
        return max(count, held), False
    return count, True


def _points(stream: BinaryIO, layout: Layout, count: int) -> np.ndarray:
    """Return the points (T, P, 3) of the frames from the stream's place on."""
    points = np.empty((count, layout.points, 3), np.float32)
    for first in range(0, count, PART):
        frames = min(PART, count - first)
        values = np.fromfile(stream, layout.kind, frames * layout.words)
        cells = values.reshape(frames, layout.words)[:, : 4 * layout.points]
        cells = cells.reshape(frames, layout.points, 4).astype(np.float32)
        places = cells[..., :3] * np.float32(1 if layout.scale < 0 else layout.scale)
        lost = (cells[..., 3] < 0) | ~np.isfinite(places).all(axis=2) | ~places.any(axis=2)
        points[first : first + frames] = np.where(lost[..., None], np.nan, places)
    return points


def _without_padding(points: np.ndarray) -> np.ndarray:
    """Return frames up to the last that holds a point, and no fewer than the counter's end."""
    seen = np.flatnonzero(np.isfinite(points[COUNTER_END:]).any(axis=(1, 2)))
    return points[: COUNTER_END + (seen[-1] + 1 if seen.size else 0)]


def _labels(stated: dict[str, list], count: int) -> list[str]:
    """Return the labels of all points; those that have none are numbered."""
    labels = list(stated["POINT:LABELS"])
    more = 2
    while stated.get(f"POINT:LABELS{more}"):
        labels += stated[f"POINT:LABELS{more}"]
        more += 1
    labels = (labels + [""] * count)[:count]
    return [label or f"unlabelled_{number:03d}" for number, label in enumerate(labels)]


def _first(stated: dict[str, list], name: str, otherwise: float = 0.0) -> float:
    """Return the first value of a parameter of numbers."""
    value = (stated.get(name) or [otherwise])[0]
    return value if not isinstance(value, str) and np.isfinite(value) else otherwise


def _word(header: np.ndarray, place: int) -> int:
    """Return a 16-bit word of the header, counted from 0."""
    return int(header.view("<u2")[place])


def _float(header: np.ndarray, place: int) -> float:
    """Return the float that begins with a word of the header."""
    return float(header[2 * place : 2 * place + 4].view("<f4")[0])
