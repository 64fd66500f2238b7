"""A character's virtual markers: the place on its mesh that each of the actor's points stands for.

A tab-separated table `point, vertex`: the name of a marker or of a point of the film, and the
vertex, counted from 0 in the order of the mesh's file. Several vertices between commas, such as
`310,311,350`, stand for the place between them, in shares that a column `shares` may give, such as
`0.5,0.3,0.2`. Points that are not listed are not used.
"""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import delimited, errors

FEWEST = 4


@dataclasses.dataclass(frozen=True)
class VirtualMarkers:
    """Where M of an actor's P points lie on a mesh.

    Attributes
    ----------
    points : (M,) int array, which of the P points, ascending
    vertices : (M, N) int array
    shares : (M, N) float array, of each vertex in the place; one in sum
    """

    points: np.ndarray
    vertices: np.ndarray
    shares: np.ndarray


def read(path: str | Path, names: Sequence[str], count: int) -> VirtualMarkers:
    """Read the table for an actor's points and a mesh.

    Parameters
    ----------
    path : the table
    names : the actor's P points
    count : vertices of the mesh

    Raises
    ------
    errors.InputError
        naming the line of a point that the actor lacks or of a vertex that the mesh lacks, or
        saying that too few points are listed
    """
    place = {name: index for index, name in enumerate(names)}
    found: dict[int, tuple[list[int], list[float]]] = {}
    for row in delimited.read(path, ("point", "vertex"), ("shares",)):
        name = row.cells["point"]
        if name not in place:
            message = f"line {row.line}, column point: the actor has no point '{name}', its first"
            raise errors.InputError(path, f"{message} is {names[0]}: rename it or drop the row")
        if place[name] in found:
            raise errors.InputError(path, f"line {row.line}: {name} stands twice, remove one")
        vertices = _vertices(path, row, count)
        found[place[name]] = vertices, _shares(path, row, len(vertices))
    if len(found) < FEWEST:
        message = f"lists {len(found)} of the actor's points, at least {FEWEST} are needed: add"
        raise errors.InputError(path, f"{message} rows of point and vertex")
    longest = max(len(vertices) for vertices, _ in found.values())
    made = VirtualMarkers(
        np.array(sorted(found)),
        np.zeros((len(found), longest), int),
        np.zeros((len(found), longest)),
    )
    for number, point in enumerate(made.points):
        vertices, shares = found[point]
        made.vertices[number, : len(vertices)] = vertices
        made.shares[number, : len(vertices)] = shares
    return made


def _vertices(path: str | Path, row: delimited.Row, count: int) -> list[int]:
    """Return the vertices of a row."""
    cells = [cell.strip() for cell in row.cells["vertex"].split(",")]
    for cell in cells:
        if not (cell.isdecimal() and int(cell) < count):
            message = f"line {row.line}, column vertex: '{cell}' is no vertex: they run from 0 to"
            raise errors.InputError(path, f"{message} {count - 1}")
    return [int(cell) for cell in cells]


def _shares(path: str | Path, row: delimited.Row, count: int) -> list[float]:
    """Return the shares of a row's vertices, even ones where its cell is blank."""
    cell = row.cells.get("shares", "")
    try:
        shares = [float(part) for part in cell.split(",")] if cell else [1.0] * count
    except ValueError:
        shares = []
    total = sum(shares)
    if len(shares) != count or not 0 < total < float("inf"):
        message = f"line {row.line}, column shares: '{cell}' is not a number for each of the"
        raise errors.InputError(path, f"{message} {count} vertices: write them between commas")
    return [share / total for share in shares]
