"""Meshes as artists save them: vertices, polygons and vertex colours of an OBJ or PLY file.

The order of the vertices is the file's to the letter, unreferenced ones included, and polygons
keep their corners. trimesh cannot promise that: it splits vertices at seams of texture
coordinates, cuts quads into triangles, and fails without the line at fault. So the few lines of
the two formats that matter here are read by `obj` and `ply`; trimesh is the tests' second reader.
"""

import dataclasses
from pathlib import Path

import numpy as np

from stages.files import errors, obj, ply

READERS = {".obj": obj.read, ".ply": ply.read}


@dataclasses.dataclass(frozen=True)
class Mesh:
    """A mesh as its file has it.

    Attributes
    ----------
    vertices : (V, 3) float64 array [the file's unit]
    sizes : (F,) int32 array, corners of each polygon
    corners : (sum of sizes,) int32 array, vertex indices, polygon by polygon
    colours : (V, 3) float64 array in 0..1, or (0, 3) where the file has none
    """

    vertices: np.ndarray
    sizes: np.ndarray
    corners: np.ndarray
    colours: np.ndarray


def read(path: str | Path) -> Mesh:
    """Read an OBJ or PLY mesh.

    Raises
    ------
    errors.InputError
        if the file is missing, of another format, has no vertices, a coordinate or colour that is
        no finite number, or a polygon that names a vertex that does not exist
    """
    path = Path(path)
    if path.suffix.lower() not in READERS:
        raise errors.InputError(path, f"'{path.suffix}' is no mesh format: save it as .obj or .ply")
    if not path.is_file():
        raise errors.InputError(path, "no such mesh: save it under this name, or correct the name")
    vertices, sizes, corners, colours = READERS[path.suffix.lower()](path)
    mesh = Mesh(
        np.array(vertices, float).reshape(-1, 3),
        np.array(sizes, np.int32),
        np.array(corners, np.int32),
        _colours(colours),
    )
    _check(path, mesh)
    return mesh


def _colours(values: np.ndarray | list) -> np.ndarray:
    """Return colours in 0..1, as some programs write them, where others write 0 to 255."""
    colours = np.array(values, float).reshape(-1, 3)
    return np.clip(colours / 255 if colours.max(initial=0.0) > 1 else colours, 0.0, 1.0)


def _check(path: Path, mesh: Mesh) -> None:
    """Refuse meshes that nothing can be made of."""
    count = len(mesh.vertices)
    if not count:
        raise errors.InputError(path, "has no vertices: export the mesh again")
    bad = np.flatnonzero(~np.isfinite(mesh.vertices).all(axis=1))
    if len(bad):
        found = " ".join(f"{value:g}" for value in mesh.vertices[bad[0]])
        message = f"vertex {bad[0]} is '{found}', not finite: repair it and export again"
        raise errors.InputError(path, message)
    bad = np.flatnonzero(~np.isfinite(mesh.colours).all(axis=1))
    if len(bad):
        message = f"the colour of vertex {bad[0]} is not finite: paint it and export again"
        raise errors.InputError(path, message)
    outside = np.flatnonzero((mesh.corners < 0) | (mesh.corners >= count))
    if len(outside):
        face = int(np.searchsorted(np.cumsum(mesh.sizes), outside[0], side="right"))
        message = f"face {face} names vertex {mesh.corners[outside[0]]}, the file has {count}"
        raise errors.InputError(path, message + " (counted from 0): export the whole mesh again")
