"""Marker takes in TRC files of Motion Analysis and OpenSim.

Text with tabs: `PathFileType`, a line of names and one of values (DataRate, NumFrames, NumMarkers,
Units and others), `Frame# Time` and the labels, `X1 Y1 Z1 ...`, then a row for each frame. Blank
cells, or three zeros, are gaps.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from stages.files import errors, marker_rows, marker_take

KIND = "PathFileType"
NEEDED = ("DataRate", "NumFrames", "NumMarkers", "Units")


def read(path: str | Path) -> marker_take.MarkerTake:
    """Read the markers of a TRC file.

    Raises
    ------
    errors.InputError
        if the file is of another kind, damaged, or cut short
    """
    lines = marker_rows.lines_of(path, "\t")
    stated = _header(path, lines)
    number, labels = _next(path, lines)
    names = [label for label in labels[2:] if label]
    if len(names) != int(stated["NumMarkers"]):
        message = f"line {number} has {len(names)} labels, NumMarkers is {stated['NumMarkers']:g}"
        raise errors.InputError(path, message + ": export it again")
    marker_take.check_names(path, names)
    _next(path, lines)
    header = ["Frame#", "Time"] + [f"{name} {axis}" for name in names for axis in "XYZ"]
    rows = marker_rows.read(path, lines, header, range(2, len(header)), 0, 1)
    promised = int(stated["NumFrames"])
    if len(rows.values) < promised:
        message = f"is cut short: {len(rows.values)} of {promised} promised frames"
        raise errors.InputError(path, message + "; copy or export it again")
    values, by_times = marker_rows.on_frames(path, rows)
    points = values.reshape(len(values), len(names), 3)
    points[~points.any(axis=2)] = np.nan
    rates = {"DataRate": stated["DataRate"]}
    if by_times is not None:
        rates["its times"] = by_times
    return marker_take.MarkerTake(names, points, stated["Units"], rates)


def _header(path: str | Path, lines: Iterator[tuple[int, list[str]]]) -> dict:
    """Return the values that the first three lines state."""
    _, first = _next(path, lines)
    if first[0] != KIND:
        message = f"begins with '{first[0][:40]}', a TRC file with {KIND}: is it of another kind?"
        raise errors.InputError(path, message)
    (_, names), (number, cells) = _next(path, lines), _next(path, lines)
    stated = dict(zip(names, cells, strict=False))
    for name in NEEDED:
        if not stated.get(name):
            raise errors.InputError(path, f"line {number} lacks {name}: export it again")
    for name in NEEDED[:3]:
        try:
            stated[name] = float(stated[name])
        except ValueError:
            stated[name] = 0.0
        if not 0 < stated[name] < 1e9:
            message = f"line {number}: {name} is no number above 0: export it again"
            raise errors.InputError(path, message)
    return stated


def _next(path: str | Path, lines: Iterator[tuple[int, list[str]]]) -> tuple[int, list[str]]:
    """Return the next line that is not blank, or say that the file ends."""
    for number, cells in lines:
        if any(cells):
            return number, cells
    raise errors.InputError(path, "ends within its header: is it cut short? export it again")
