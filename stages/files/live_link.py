"""Live Link Face takes: text tables with a timecode, 52 curves and nine angles in each row.

The timecode is `HH:MM:SS:FF.mmm`, and FF counts sixtieths of a second whatever the camera's rate;
a longer take in which it never goes so far counts the frames of a lower rate. Yaw is positive to
the subject's right and pitch downwards, as the eyes of recorded takes show; roll is taken to be
mirrored like yaw. Rows whose curves are blank are frames on which no face was found.
"""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import curve_take, errors, headed_text, marker_rows, shape_names

TIMECODE = re.compile(r"(\d{1,2}):(\d{2}):(\d{2})[:;.](\d{1,3}(?:\.\d+)?)")
ANGLES = {
    "head": ("headyaw", "headpitch", "headroll"),
    "eye_left": ("lefteyeyaw", "lefteyepitch", "lefteyeroll"),
    "eye_right": ("righteyeyaw", "righteyepitch", "righteyeroll"),
}
MIRRORED = np.array([-1.0, 1.0, -1.0])
BASES = (24, 25, 30, 48, 50, 60)  # frames that a second of timecode may have
TELLING_S = 2  # seconds after which the largest frame number shows how many a second has
DAY_S = 86400.0


def is_live_link(header: Sequence[str]) -> bool:
    """Say whether a header is that of Live Link Face."""
    return bool(header) and header[0].lower() == "timecode"


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
    times, values, lines = [], [], []
    for line, cells in sheet.lines:
        if not any(cells):
            continue
        if len(cells) != len(header):
            message = f"line {line} has {len(cells)} cells, the header has {len(header)}"
            raise errors.InputError(path, message + ": is it cut short? copy it again")
        times.append(_timecode(path, line, cells[0]))
        values.append(_values(path, line, cells, header, sheet.decimal))
        lines.append(line)
    if not times:
        raise errors.InputError(path, "holds no row below its header: copy it again")
    columns = dict(zip((name.lower() for name in header[1:]), np.array(values).T, strict=True))
    angles = {}
    for part, names in ANGLES.items():
        if all(name in columns for name in names):
            turns = np.stack([columns.pop(name) for name in names], axis=1)
            angles[part] = turns * MIRRORED
    kept = [name for name in header[1:] if name.lower() in columns]
    stacked = np.stack([columns[name.lower()] for name in kept], axis=1)
    curves, unknown = curve_take.gather(table, kept, stacked)
    return curve_take.CurveTake(
        curves, unknown, _seconds(path, np.array(times), lines), midnight=True, angles=angles
    )


def _timecode(path: str | Path, line: int, text: str) -> tuple[float, float]:
    """Return the whole seconds from midnight and the frames of a timecode."""
    found = TIMECODE.fullmatch(text)
    hours, minutes, seconds, part = (float(found[i]) for i in (1, 2, 3, 4)) if found else (99,) * 4
    if hours > 23 or minutes > 59 or seconds > 59 or part >= BASES[-1]:
        message = f"line {line}, column Timecode: '{text}' is no timecode HH:MM:SS:FF.mmm in"
        raise errors.InputError(path, message + " sixtieths: export it again")
    return hours * 3600 + minutes * 60 + seconds, part


def _values(
    path: str | Path, line: int, cells: Sequence[str], header: Sequence[str], decimal: str
) -> list[float]:
    """Return the numbers of a row, NaN for blanks."""
    numbers = []
    for name, cell in zip(header[1:], cells[1:], strict=True):
        text = cell.replace(decimal, ".")
        try:
            value = float("nan" if text.lower() in marker_rows.GAPS else text)
        except ValueError:
            value = np.inf
        if np.isinf(value):
            message = f"line {line}, column {name}: '{cell}' is no number"
            raise errors.InputError(path, message + ": leave it blank where there is none")
        numbers.append(value)
    return numbers


def _seconds(path: str | Path, timecodes: np.ndarray, lines: Sequence[int]) -> np.ndarray:
    """Return seconds from midnight that go on after a day; refuse timecodes that do not rise.

    Parameters
    ----------
    path, lines : for the error
    timecodes : (T, 2) float array, whole seconds and frames
    """
    whole, part = timecodes.T
    midnights = np.diff(whole) < -DAY_S / 2
    whole = whole + DAY_S * np.concatenate([[0], np.cumsum(midnights)])
    tells = whole[-1] - whole[0] >= TELLING_S
    base = next(base for base in BASES if base > part.max()) if tells else BASES[-1]
    times = whole + part / base
    if (wrong := np.flatnonzero(np.diff(times) <= 0)).size:
        message = f"line {lines[wrong[0] + 1]}: its timecode does not follow the one before"
        raise errors.InputError(path, message + ": remove rows that stand twice, sort the others")
    return times
