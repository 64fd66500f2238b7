"""Landmarks of any tracker that is read, told by what the file holds and not by its name."""

from pathlib import Path

from stages.files import (
    errors,
    headed_text,
    json_stream,
    landmark_columns,
    landmark_json,
    landmark_rows,
    landmark_take,
    pts,
)

KNOWN = (
    "JSON of MediaPipe's points, text tables with columns x_0, y_0, ... (OpenFace, py-feat, "
    "MediaPipe) or index, x, y, keyface's lips_outer_00.x, or a folder of .pts files"
)


def read(path: str | Path) -> landmark_take.LandmarkTake:
    """Read a take of landmarks.

    Raises
    ------
    errors.InputError
        if the file is missing, of no known form, or cannot be read
    """
    if Path(path).is_dir():
        return pts.read_folder(path)
    if not Path(path).is_file():
        message = "no such landmarks: check the column landmarks of shots.tsv"
        raise errors.InputError(path, message)
    if json_stream.starts_as_json(path):
        return landmark_json.read(path)
    table = headed_text.read(path)
    if landmark_columns.sets(table.header):
        return landmark_columns.read(path, table)
    if landmark_rows.is_long(table.header):
        return landmark_rows.read(path, table)
    if table.header[0].startswith("version"):
        raise errors.InputError(path, "is one frame: give the folder of all .pts files")
    first = ", ".join(table.header[:4])
    raise errors.InputError(path, f"holds no landmarks, it starts '{first[:60]}': give {KNOWN}")


def sources(path: str | Path) -> list[Path]:
    """Return the files that a take is made of."""
    return sorted(Path(path).glob("*.pts")) if Path(path).is_dir() else [Path(path)]
