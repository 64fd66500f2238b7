"""Wavefront OBJ: the lines `v` and `f`, everything else is passed over.

`v x y z`, optionally with a fourth coordinate or a colour `r g b` after it. `f` names vertices
from 1, or from the last one backwards with negative numbers, each perhaps with `/texture/normal`.
A backslash at the end continues a line.
"""

from collections.abc import Iterator
from pathlib import Path

from stages.files import errors

MIN_CORNERS = 3
MOST_VERTICES = 2**31


def read(path: Path) -> tuple[list, list, list, list]:
    """Read an OBJ file.

    Returns
    -------
    vertices : list of (x, y, z)
    sizes : corners of each polygon
    corners : vertex indices from 0, polygon by polygon
    colours : list of (r, g, b); empty unless every vertex has one

    Raises
    ------
    errors.InputError
        naming the line
    """
    vertices, sizes, corners, colours = [], [], [], []
    for number, line in _lines(path):
        if line.startswith(("v ", "v\t")):
            values = _numbers(path, number, line)
            vertices.append(values[:3])
            if len(values) >= 6:
                colours.append(values[-3:])
        elif line.startswith(("f ", "f\t")):
            polygon = _polygon(path, number, line, len(vertices))
            sizes.append(len(polygon))
            corners.extend(polygon)
    return vertices, sizes, corners, colours if len(colours) == len(vertices) else []


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the number and text of each line, continued lines joined."""
    held, start = "", 0
    with path.open(encoding="utf-8", errors="replace") as stream:
        for number, raw in enumerate(stream, start=1):
            line = raw.strip()
            start = start or number
            if line.endswith("\\"):
                held += line[:-1] + " "
                continue
            yield start, held + line
            held, start = "", 0


def _numbers(path: Path, number: int, line: str) -> list[float]:
    """Return the numbers of a `v` line."""
    cells = line.split()[1:]
    try:
        values = [float(cell) for cell in cells]
    except ValueError:
        message = f"line {number}: '{line}' holds no numbers: export with points as decimal signs"
        raise errors.InputError(path, message) from None
    if len(values) not in (3, 4, 6, 7):
        message = f"line {number}: a vertex has {len(values)} numbers in place of 3: export again"
        raise errors.InputError(path, message)
    return values


def _polygon(path: Path, number: int, line: str, count: int) -> list[int]:
    """Return the vertex indices of an `f` line, from 0; `count` vertices stand above it."""
    try:
        named = [int(cell.split("/", 1)[0]) for cell in line.split()[1:]]
    except ValueError:
        message = f"line {number}: '{line}' is no face: export again"
        raise errors.InputError(path, message) from None
    if len(named) < MIN_CORNERS or 0 in named:
        message = f"line {number}: '{line}' is no face of vertices counted from 1: export again"
        raise errors.InputError(path, message)
    indices = [index - 1 if index > 0 else count + index for index in named]
    if min(indices) < 0:
        message = f"line {number}: '{line}' names a vertex above the first: export again"
        raise errors.InputError(path, message)
    if max(indices) >= MOST_VERTICES:
        message = f"line {number}: '{line:.80}' names a vertex beyond the last: export again"
        raise errors.InputError(path, message)
    return indices
