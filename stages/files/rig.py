"""`rig.npz`: all that is needed to move a character, whatever method drives it.

Arrays: `neutral` (V, D); K shapes as unmasked differences from it, of which only the vertices that
move are held: `first` (K + 1,), `vertices` (N,) and `values` (N, D); `masks` (R, V), `mask_index`
(K,), `sizes` and `corners` of the polygons, `colours` (V, 3) or (0, 3), `pivot` (3,).
The header: `form` (`mesh` or `controls`), `names` (K, `<mask>.<shape>`), `mask_names` (R),
`controls` (V names; empty for a mesh), `unit`, `up_axis`, `face_unit`. A table of controls is a
rig with V controls of one coordinate (D = 1).
"""

import dataclasses
import hashlib
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from stages.core import local_shapes
from stages.files import errors, model

KIND = "rig"
METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}


@dataclasses.dataclass(frozen=True)
class Rig:
    """A character's rig.

    Attributes
    ----------
    names : K names `<mask>.<shape>`
    mask_names : R names
    controls : V names for a table of controls, else empty
    neutral : (V, D) float64 array [unit]
    deltas : K shapes of V vertices, unmasked [unit]
    masks : (R, V) float64 array, one at every vertex in sum
    mask_index : (K,) int array
    sizes, corners, colours : polygons and vertex colours as in `mesh.Mesh`
    pivot : (3,) float64 array [unit]
    unit : name of the unit of the coordinates
    up_axis : `y` or `z`
    face_unit : length of one face unit [unit]
    """

    names: list[str]
    mask_names: list[str]
    controls: list[str]
    neutral: np.ndarray
    deltas: local_shapes.LocalShapes
    masks: np.ndarray
    mask_index: np.ndarray
    sizes: np.ndarray
    corners: np.ndarray
    colours: np.ndarray
    pivot: np.ndarray
    unit: str
    up_axis: str
    face_unit: float


ARRAYS = ("neutral", "masks", "mask_index", "sizes", "corners", "colours", "pivot")
SHAPES = ("first", "vertices", "values")
HEADER = ("names", "mask_names", "controls", "unit", "up_axis", "face_unit")


def write(path: str | Path, rig: Rig, sources: Iterable[str | Path] = ()) -> None:
    """Write a rig."""
    form = "controls" if rig.controls else "mesh"
    header = {"form": form} | {name: getattr(rig, name) for name in HEADER}
    arrays = {name: getattr(rig, name) for name in ARRAYS}
    arrays |= {name: getattr(rig.deltas, name) for name in SHAPES}
    model.write(path, KIND, arrays, header, sources)


def read(path: str | Path, form: str) -> Rig:
    """Read a rig of one form, `mesh` or `controls`.

    Raises
    ------
    errors.InputError
        if the file is no rig, or one of the other form
    """
    rig = read_any(path)
    found = "controls" if rig.controls else "mesh"
    if found != form:
        message = f"is a rig of form '{found}', expected '{form}'"
        raise errors.InputError(path, message + ": the neutral decides that, .csv or a mesh")
    return rig


def read_any(path: str | Path) -> Rig:
    """Read a rig of either form.

    Raises
    ------
    errors.InputError
        if the file is no rig, or one of another version
    """
    arrays, header = model.read(path, KIND)
    for name in (*ARRAYS, *SHAPES, *HEADER):
        if name not in (header if name in HEADER else arrays):
            raise errors.InputError(path, f"holds no {name}: delete it and run again")
    deltas = local_shapes.LocalShapes(*(arrays[n] for n in SHAPES), len(arrays["neutral"]))
    fields = {n: arrays[n] for n in ARRAYS} | {n: header[n] for n in HEADER}
    return Rig(deltas=deltas, **fields)


def pivot(name: str, text: str) -> np.ndarray:
    """Return the three coordinates of a setting `x y z`.

    Raises
    ------
    errors.InputError
        if the text is not three finite numbers
    """
    try:
        values = np.array([float(cell) for cell in text.split()])
    except ValueError:
        values = np.zeros(0)
    if values.shape != (3,) or not np.isfinite(values).all():
        raise errors.InputError(name, f"'{text}' is not three numbers 'x y z'")
    return values


def vertex_hash(rig: Rig) -> str:
    """Return the sha256 over the neutral's float32 positions and its polygons, little-endian.

    Two files with the same hash have the same vertices in the same order.
    """
    digest = hashlib.sha256(rig.neutral.astype("<f4").tobytes())
    for array in (rig.sizes, rig.corners):
        digest.update(array.astype("<i4").tobytes())
    return digest.hexdigest()
