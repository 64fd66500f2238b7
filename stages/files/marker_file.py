"""Marker takes of any kind that is read: C3D, TRC, wide CSV."""

from collections.abc import Callable
from pathlib import Path

from stages.files import c3d, errors, marker_csv, marker_take, trc

READERS: dict[str, Callable[[str | Path], marker_take.MarkerTake]] = {
    ".c3d": c3d.read,
    ".trc": trc.read,
    ".csv": marker_csv.read,
    ".tsv": marker_csv.read,
    ".txt": marker_csv.read,
}


def read(path: str | Path) -> marker_take.MarkerTake:
    """Read a take by the ending of its name.

    Raises
    ------
    errors.InputError
        if the file is missing, of no known kind, or cannot be read
    """
    reader = READERS.get(Path(path).suffix.lower())
    if reader is None:
        message = f"is no marker file by its name: give one that ends in {', '.join(READERS)}"
        raise errors.InputError(path, message)
    if not Path(path).is_file():
        raise errors.InputError(path, "no such marker file: check the column markers of shots.tsv")
    return reader(path)
