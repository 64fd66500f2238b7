"""What every USD file here has: axes, unit, clock, and the character's polygons.

`/character` is the default prim. Time codes are frame numbers, so a frame is exact at any rate;
`timeCodesPerSecond` is the rate, `startTimeCode` and `endTimeCode` are the first and last frame.
`customLayerData` holds `keyface`: fps_num, fps_den, first_frame, frames, unit, vertex_hash
and, where it is known, start_timecode.
Coordinates are the character's own; `upAxis` and `metersPerUnit` say what they mean. Meshes have no
subdivision and no normals: viewers find smooth ones from the points as they move.
"""

import contextlib
from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, Vt

from stages.core import srgb
from stages.files import errors, rig

SUFFIXES = (".usd", ".usda", ".usdc")
ROOT = "/character"


@contextlib.contextmanager
def stage(
    path: str | Path,
    character: rig.Rig,
    frame: np.ndarray,
    rate: Fraction,
    start: Mapping[str, str] | None = None,
) -> Iterator[Usd.Stage]:
    """Yield a stage with a root prim, axes, unit and clock; save it at the end.

    Parameters
    ----------
    path : the file, new
    character : the rig of a mesh
    frame : (T,) int array
    rate : frames per second
    start : what else is said of the first frame, such as its timecode
    """
    if Path(path).suffix not in SUFFIXES:
        message = f"'{Path(path).suffix}' is none of {', '.join(SUFFIXES)}: name it so"
        raise errors.InputError(path, message)
    Path(path).touch()  # says by itself what is wrong where nothing can be written
    made = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(made, getattr(UsdGeom.Tokens, character.up_axis))
    UsdGeom.SetStageMetersPerUnit(made, rig.METRES[character.unit])
    made.SetTimeCodesPerSecond(float(rate))
    made.SetFramesPerSecond(float(rate))
    made.SetStartTimeCode(float(frame[0]))
    made.SetEndTimeCode(float(frame[-1]))
    root = UsdGeom.Xform.Define(made, ROOT)
    made.SetDefaultPrim(root.GetPrim())
    made.GetRootLayer().customLayerData = {
        "keyface": {
            "fps_num": rate.numerator,
            "fps_den": rate.denominator,
            "first_frame": int(frame[0]),
            "frames": len(frame),
            "unit": character.unit,
            "vertex_hash": rig.vertex_hash(character),
            **(start or {}),
        }
    }
    yield made
    save(made, path)


def save(made: Usd.Stage, path: str | Path) -> None:
    """Write what was added since the last time, and let go of its memory.

    Raises
    ------
    errors.InputError
        if the file cannot be written
    """
    try:
        made.GetRootLayer().Save()
    except Tf.ErrorException as error:
        raise errors.InputError(path, "cannot be written: is the disk full?") from error


def mesh(made: Usd.Stage, path: str, character: rig.Rig) -> UsdGeom.Mesh:
    """Define the mesh of the neutral, with the file's polygons and colours."""
    face = UsdGeom.Mesh.Define(made, path)
    face.CreatePointsAttr(vectors(character.neutral))
    face.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.asarray(character.sizes, np.int32)))
    face.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(np.asarray(character.corners, np.int32)))
    face.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    face.CreateOrientationAttr(UsdGeom.Tokens.rightHanded)
    face.CreateDoubleSidedAttr(True)
    face.CreateExtentAttr(extent(character.neutral))
    if len(character.colours):
        colours = face.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex)
        colours.Set(vectors(srgb.linear(character.colours)))
    return face


def vectors(rows: np.ndarray) -> Vt.Vec3fArray:
    """Return (N, 3) numbers as float32 vectors."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(rows, np.float32))


def extent(points: np.ndarray) -> Vt.Vec3fArray:
    """Return the two corners of a box round (V, 3) points, as the file's float32 has them."""
    rounded = np.asarray(points, np.float32)
    return vectors(np.stack([rounded.min(axis=0), rounded.max(axis=0)]))


def place(values: np.ndarray) -> Gf.Vec3d:
    """Return three coordinates in double precision."""
    return Gf.Vec3d(*map(float, values))


def prim_names(names: list[str]) -> list[str]:
    """Return a name for each that USD allows (letters, digits, underscores), all different."""
    made: list[str] = []
    for name in names:
        plain = wanted = Tf.MakeValidIdentifier(name)
        number = 2
        while plain in made:
            plain, number = f"{wanted}_{number}", number + 1
        made.append(plain)
    return made


def child(path: str, name: str) -> str:
    """Return the path of a child prim."""
    return str(Sdf.Path(path).AppendChild(name))
