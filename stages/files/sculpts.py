"""A character's poses as files, whether meshes or tables of controls.

A sculpt is `<sculpts folder>/<region>/<key shape><suffix of the neutral>`.
"""

import dataclasses
from pathlib import Path

import numpy as np

from stages.files import controls, errors, mesh

CONTROL_SUFFIX = ".csv"


@dataclasses.dataclass(frozen=True)
class Pose:
    """The neutral, which every sculpt is read against.

    Attributes
    ----------
    names : V names, a vertex's number or a control's name
    coordinates : (V, D) float64 array, D = 3 for a mesh and 1 for controls
    sizes, corners, colours : polygons and vertex colours as in `mesh.Mesh`
    is_controls : whether it is a table of controls
    """

    names: list[str]
    coordinates: np.ndarray
    sizes: np.ndarray
    corners: np.ndarray
    colours: np.ndarray
    is_controls: bool


def path_of(folder: str | Path, region: str, key_shape: str, neutral: str | Path) -> Path:
    """Return where the sculpt of a key shape is expected."""
    return Path(folder) / region / (key_shape + Path(neutral).suffix)


def read_neutral(path: str | Path) -> Pose:
    """Read a neutral, a mesh or a table of controls by its suffix."""
    if Path(path).suffix == CONTROL_SUFFIX:
        pose = controls.read(path)
        none = np.zeros(0, np.int32)
        values = np.array(list(pose.values())).reshape(-1, 1)
        return Pose(list(pose), values, none, none, np.zeros((0, 3)), is_controls=True)
    read = mesh.read(path)
    names = [str(vertex) for vertex in range(len(read.vertices))]
    return Pose(names, read.vertices, read.sizes, read.corners, read.colours, is_controls=False)


def read_sculpt(path: str | Path, neutral: Pose) -> tuple[np.ndarray, bool]:
    """Read a sculpt of a neutral.

    Returns
    -------
    coordinates : (V, D) float64 array
    same_polygons : whether its polygons are the neutral's, in the same order

    Raises
    ------
    errors.InputError
        if it cannot be read, or has other vertices or controls than the neutral
    """
    if neutral.is_controls:
        values = controls.in_order(path, controls.read(path), neutral.names)
        return np.array(values).reshape(-1, 1), True
    read = mesh.read(path)
    if len(read.vertices) != len(neutral.coordinates):
        found, wanted = len(read.vertices), len(neutral.coordinates)
        message = f"has {found} vertices, the neutral has {wanted}: sculpt on a copy of the neutral"
        raise errors.InputError(path, message + ", and export without merging or splitting")
    same = np.array_equal(read.sizes, neutral.sizes) and np.array_equal(
        read.corners, neutral.corners
    )
    return read.vertices, same
