"""Landmark maps: tab-separated `index, point`, a tracker's number of a point and its name here.

A map is called after its tracker. Points are named as labels are, `<contour>_<NN>` in order along
the contour.
"""

from collections.abc import Sequence
from pathlib import Path

from stages.files import delimited, errors

COLUMNS = ("index", "point")


def read(path: str | Path) -> dict[str, int]:
    """Read a map: point -> index.

    Raises
    ------
    errors.InputError
        naming line and cell
    """
    indices: dict[str, int] = {}
    for row in delimited.read(path, COLUMNS):
        name = row.cells["point"]
        if not name or name in indices or any(letter in name for letter in ".:/\\"):
            message = f"line {row.line}, column point: '{name}' is blank, stands twice or holds"
            raise errors.InputError(path, message + " a dot, colon or slash: rename it")
        indices[name] = delimited.whole_number(path, row, "index")
    if not indices:
        raise errors.InputError(path, "names no point: add a row for each")
    return indices


def choose(paths: Sequence[str], trackers: Sequence[str], file: str | Path) -> tuple[str, str]:
    """Return the first tracker that has a map, and that map.

    Raises
    ------
    errors.InputError
        naming the file whose tracker has none
    """
    for tracker in trackers:
        for path in paths:
            if Path(path).stem == tracker:
                return tracker, path
    known = ", ".join(sorted(Path(path).stem for path in paths)) or "none"
    message = f"holds points of {' or '.join(trackers)}, the maps given are {known}"
    raise errors.InputError(file, message + ": give its map too")
