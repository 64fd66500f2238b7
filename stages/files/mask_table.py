"""The masks of a character: which of its vertices follow which region, and how much.

A tab-separated table in one of two forms. By vertices, `vertex, region, weight`: vertices counted
from 0 in the order of the mesh's file (for a table of controls, the control's name); vertices that
a region does not list have weight 0 in it; at every vertex the weights sum to one.

By linear ramps between two heights, `region, axis, from, to` and perhaps `vertices`, a row a
region: its weight rises from 0 at `from` to 1 at `to` along `axis` (x, y or z of the file; `from`
may be the greater), and what the rows above held shrinks accordingly. The first row without
heights has everything to begin with. A row with `vertices`, such as `310-341,400`, takes those
wholly, whatever its place. So eyes above a mouth, with pupils that are listed, read

    region  axis  from   to     vertices
    mouth
    eyes    y     -0.2   0.1
    pupils                      310-341

A region that ends with no weight anywhere needs no sculpts. (In this form: a row of the region
alone that is not the first such row.)
"""

import dataclasses
from pathlib import Path

import numpy as np

from stages.files import delimited, errors

AXES = "xyz"


@dataclasses.dataclass(frozen=True)
class MaskTable:
    """A masks table as read.

    Attributes
    ----------
    regions : names of the R regions, in the table's order
    given : (R, V) float array of the form by vertices; zeros in the form by ramps
    rest : the region that has everything to begin with; None in the form by vertices
    ramps : (region, axis, from, to) of each ramp, region and axis by number
    listed : (region, vertices) of each row that takes vertices wholly
    """

    regions: list[str]
    given: np.ndarray
    rest: int | None
    ramps: list[tuple[int, int, float, float]]
    listed: list[tuple[int, list[int]]]


def read(path: str | Path, names: list[str], dimensions: int) -> MaskTable:
    """Read the masks of a character.

    Parameters
    ----------
    path : the table
    names : of the V vertices or controls, by which the table may call them
    dimensions : coordinates of each, 3 for a mesh and 1 for controls

    Raises
    ------
    errors.InputError
        naming the line
    """
    try:
        with Path(path).open(encoding="utf-8-sig", errors="replace") as stream:
            header = [cell.strip() for cell in stream.readline().split("\t")]
    except FileNotFoundError:
        header = []
    if "vertex" in header:
        return _by_vertices(path, names)
    return _by_ramps(path, len(names), dimensions)


def _by_vertices(path: str | Path, names: list[str]) -> MaskTable:
    """Read the form `vertex, region, weight`."""
    place = {name: index for index, name in enumerate(names)}
    regions: dict[str, np.ndarray] = {}
    seen = set()
    for row in delimited.read(path, ("vertex", "region", "weight")):
        vertex, region = row.cells["vertex"], row.cells["region"]
        if vertex not in place:
            message = f"line {row.line}: no vertex '{vertex}': they run from {names[0]}"
            raise errors.InputError(path, f"{message} to {names[-1]}")
        if (vertex, region) in seen:
            message = f"line {row.line}: vertex {vertex} stands twice in {region}: remove one"
            raise errors.InputError(path, message)
        seen.add((vertex, region))
        mask = regions.setdefault(region, np.zeros(len(names)))
        mask[place[vertex]] = delimited.number(path, row, "weight")
    if not regions:
        raise errors.InputError(path, "lists no vertex: add rows of vertex, region and weight")
    return MaskTable(list(regions), np.stack(list(regions.values())), None, [], [])


def _by_ramps(path: str | Path, count: int, dimensions: int) -> MaskTable:
    """Read the form `region, axis, from, to, vertices`."""
    rows = delimited.read(path, ("region", "axis", "from", "to"), ("vertices",))
    regions = [row.cells["region"] for row in rows]
    for row in rows:
        if regions.count(row.cells["region"]) > 1:
            raise errors.InputError(path, f"line {row.line}: one row for each region")
    plain = [i for i, row in enumerate(rows) if not any(_heights(row)) and not _listed(row)]
    if not plain:
        message = "no row without heights and vertices: add one, it has what the others leave"
        raise errors.InputError(path, message)
    ramps = [(i, *_ramp(path, row, dimensions)) for i, row in enumerate(rows) if any(_heights(row))]
    listed = [(i, _vertices(path, row, count)) for i, row in enumerate(rows) if _listed(row)]
    return MaskTable(regions, np.zeros((len(rows), count)), plain[0], ramps, listed)


def _heights(row: delimited.Row) -> list[str]:
    """Return the three cells of a ramp."""
    return [row.cells[column] for column in ("axis", "from", "to")]


def _listed(row: delimited.Row) -> str:
    """Return the cell that lists vertices; blank where there is none."""
    return row.cells.get("vertices", "")


def _ramp(path: str | Path, row: delimited.Row, dimensions: int) -> tuple[int, float, float]:
    """Return the axis' number and the two heights of one row."""
    axis = row.cells["axis"]
    if dimensions < 2 or axis not in list(AXES[:dimensions]):
        message = f"line {row.line}, column axis: '{axis}' is no axis of the character's points"
        raise errors.InputError(path, message)
    start, end = delimited.number(path, row, "from"), delimited.number(path, row, "to")
    if start == end:
        message = f"line {row.line}: from and to are both {start:g}: give two heights"
        raise errors.InputError(path, message)
    return AXES.index(axis), start, end


def _vertices(path: str | Path, row: delimited.Row, count: int) -> list[int]:
    """Return the vertices that a row lists, such as `310-341,400`."""
    vertices = []
    for part in row.cells["vertices"].split(","):
        first, _, last = (cell.strip() for cell in part.partition("-"))
        if not (first.isdecimal() and (last or first).isdecimal()):
            message = f"line {row.line}, column vertices: '{part}' is no range such as 310-341"
            raise errors.InputError(path, message)
        if not int(first) <= int(last or first) < count:
            message = f"line {row.line}, column vertices: '{part}' is not within 0-{count - 1}"
            raise errors.InputError(path, message)
        vertices.extend(range(int(first), int(last or first) + 1))
    return vertices
