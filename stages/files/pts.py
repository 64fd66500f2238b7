"""Folders of ibug `.pts` files: the points of one picture in each, numbered by their names.

Text: `version: 1`, `n_points: 68`, `{`, a line `x y` for each point, `}`. Pixels count from 1: the
centre of the first is (1, 1).
"""

import re
from pathlib import Path

import numpy as np

from stages.files import errors, landmark_take, text_file

FORM = re.compile(r"\s*(?:version\s*:\s*\S+\s+)?n_points\s*:\s*(\d{1,9})\s*\{([^{}]*)\}\s*")
NUMBER = re.compile(r"\d+")
SHIFT = -0.5


def read_folder(path: str | Path) -> landmark_take.LandmarkTake:
    """Read a take; pictures without a file are gaps.

    The last number in a file's name is that of its picture.

    Raises
    ------
    errors.InputError
        naming the file that cannot be read
    """
    files: dict[int, Path] = {}
    for file in sorted(Path(path).glob("*.pts")):
        digits = NUMBER.findall(file.stem)
        if not digits:
            raise errors.InputError(file, "has no number in its name: name it after its frame")
        number = int(digits[-1][-9:])
        if number in files:
            message = f"has the number {number} of {files[number].name}: rename one"
            raise errors.InputError(file, message)
        files[number] = file
    if not files:
        raise errors.InputError(path, "holds no .pts file: give the folder with the points")
    numbers = sorted(files)
    points = [_read(files[number]) for number in numbers]
    for number, found in zip(numbers, points, strict=True):
        if len(found) != len(points[0]):
            message = f"has {len(found)} points, {files[numbers[0]].name} {len(points[0])}"
            raise errors.InputError(files[number], message + ": export all alike")
    return landmark_take.LandmarkTake(
        {landmark_take.tracker_of(path, len(points[0])): np.stack(points)},
        [],
        np.ones(len(points)),
        frame=np.array(numbers),
        first=0 if numbers[0] == 0 else None,
        shift=SHIFT,
    )


def _read(path: Path) -> np.ndarray:
    """Return the points (P, 2) of one picture, as the file counts pixels."""
    found = FORM.fullmatch(text_file.read(path))
    if not found:
        message = "is no .pts file of points between { and }: is it cut short? export it again"
        raise errors.InputError(path, message)
    lines = [line.split() for line in found[2].splitlines() if line.strip()]
    if len(lines) != int(found[1]):
        message = f"has {len(lines)} points and says {found[1]}: is it cut short? export it again"
        raise errors.InputError(path, message)
    try:
        points = np.array(lines, float).reshape(len(lines), 2)
    except ValueError:
        points = np.array([np.nan])
    if not np.isfinite(points).all():
        raise errors.InputError(path, "not all its points are two numbers: export it again")
    return points
