"""`mesh.usdc`: the moving character as UsdSkel blend shapes, evaluated by any USD viewer.

    /character          Xform; scaled about the pivot where the head motion has a scale
      /rig              SkelRoot
        /skeleton       Skeleton of one joint, `head`, at the pivot
        /motion         SkelAnimation: the joint's turn and place, and the blend shapes' weights
        /face           Mesh, all of it bound to the joint
          /<shape>      BlendShape: offsets of the vertices that move

Weights stay within 0 and 1 as in `mesh.glb`, since packages clamp them: one blend shape for each
shape that moves something and a second, `<shape>_minus`, where its weight goes below zero. Custom
data of a blend shape says `keyface:name` (`<mask>.<shape>`) and `keyface:gain`, by which its
offsets were multiplied and its weights divided. The joint does not carry the scale, because
UsdSkel has half floats for that: with `H(x) = pivot + s R (x - pivot) + f t`, the joint turns by R
and moves by f t / s, and `/character` scales by s about the pivot.
"""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdSkel, Vt

from stages.core import local_shapes, morph_sides, take_motion
from stages.files import rig, usd

RIG = f"{usd.ROOT}/rig"
FACE, SKELETON, MOTION = (f"{RIG}/{name}" for name in ("face", "skeleton", "motion"))
JOINT = "head"


def write(
    path: str | Path,
    character: rig.Rig,
    masked: local_shapes.LocalShapes,
    motion: take_motion.TakeMotion,
    boxes: np.ndarray,
    frame: np.ndarray,
    rate: Fraction,
    start: Mapping[str, str] | None = None,
) -> None:
    """Write a moving character.

    Parameters
    ----------
    path : the file, new
    character : the rig of a mesh
    masked : its K shapes under their masks
    motion : in the character's axes and unit
    boxes : (T, 2, 3) float array, least and greatest coordinates of each frame
    frame : (T,) int array
    rate : frames per second
    """
    sides = morph_sides.split(motion.weights)
    targets = local_shapes.select(masked, sides.shape, sides.gain)
    used = np.flatnonzero(local_shapes.touched(targets))
    names = [character.names[shape] for shape in sides.shape]
    minus = ["_minus" if gain < 0 else "" for gain in sides.gain]
    prims = usd.prim_names([names[row] + minus[row] for row in used])
    with usd.stage(path, character, frame, rate, start) as made:
        _scale(made, character.pivot, motion.scale, frame)
        root = UsdSkel.Root.Define(made, RIG)
        _extents(root, character.pivot, motion.scale, boxes, frame)
        _skeleton(made, character.pivot)
        face = usd.mesh(made, FACE, character)
        binding = _bind(face, len(character.neutral))
        paths = [usd.child(FACE, name) for name in prims]
        binding.CreateBlendShapesAttr(Vt.TokenArray(prims))
        binding.CreateBlendShapeTargetsRel().SetTargets(paths)
        for row, where in zip(used, paths, strict=True):
            _blend_shape(made, where, targets, row, names[row], float(sides.gain[row]))
        _animate(made, prims, sides.weights[:, used], character.pivot, motion, frame)


def _scale(made: Usd.Stage, pivot: np.ndarray, scale: np.ndarray, frame: np.ndarray) -> None:
    """Scale the root about the pivot, if anything is scaled."""
    if np.all(scale == 1.0):
        return
    root = UsdGeom.Xform(made.GetPrimAtPath(usd.ROOT))
    root.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble, "pivot").Set(usd.place(pivot))
    scaled = root.AddScaleOp(UsdGeom.XformOp.PrecisionDouble)
    for number, value in zip(frame, scale, strict=True):
        scaled.Set(Gf.Vec3d(float(value)), float(number))
    root.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble, "pivot", isInverseOp=True)


def _extents(
    root: UsdSkel.Root, pivot: np.ndarray, scale: np.ndarray, boxes: np.ndarray, frame: np.ndarray
) -> None:
    """Write the box round each frame, without the scale of the prim above."""
    extent = root.CreateExtentAttr()
    inner = pivot + (boxes - pivot) / scale[:, None, None]
    extent.Set(usd.extent(inner.reshape(-1, 3)))
    for number, box in zip(frame, inner, strict=True):
        extent.Set(usd.vectors(box), float(number))


def _skeleton(made: Usd.Stage, pivot: np.ndarray) -> None:
    """Define the skeleton: a joint at the pivot, bound to the animation."""
    skeleton = UsdSkel.Skeleton.Define(made, SKELETON)
    rest = Vt.Matrix4dArray([Gf.Matrix4d().SetTranslate(usd.place(pivot))])
    skeleton.CreateJointsAttr(Vt.TokenArray([JOINT]))
    skeleton.CreateBindTransformsAttr(rest)
    skeleton.CreateRestTransformsAttr(rest)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets([MOTION])


def _bind(face: UsdGeom.Mesh, count: int) -> UsdSkel.BindingAPI:
    """Bind every vertex of the mesh to the joint."""
    binding = UsdSkel.BindingAPI.Apply(face.GetPrim())
    binding.CreateSkeletonRel().SetTargets([SKELETON])
    binding.CreateAnimationSourceRel().SetTargets([MOTION])
    binding.CreateGeomBindTransformAttr(Gf.Matrix4d(1.0))
    indices = binding.CreateJointIndicesPrimvar(constant=False, elementSize=1)
    indices.Set(Vt.IntArray(count, 0))
    weights = binding.CreateJointWeightsPrimvar(constant=False, elementSize=1)
    weights.Set(Vt.FloatArray(count, 1.0))
    return binding


def _blend_shape(
    made: Usd.Stage,
    path: str,
    targets: local_shapes.LocalShapes,
    row: int,
    name: str,
    gain: float,
) -> None:
    """Define a blend shape by what moves."""
    part = slice(targets.first[row], targets.first[row + 1])
    shape = UsdSkel.BlendShape.Define(made, path)
    shape.CreateOffsetsAttr(usd.vectors(targets.values[part]))
    shape.CreatePointIndicesAttr(Vt.IntArray.FromNumpy(targets.vertices[part].astype(np.int32)))
    shape.GetPrim().SetCustomDataByKey("keyface:name", name)
    shape.GetPrim().SetCustomDataByKey("keyface:gain", gain)


def _animate(
    made: Usd.Stage,
    prims: list[str],
    weights: np.ndarray,
    pivot: np.ndarray,
    motion: take_motion.TakeMotion,
    frame: np.ndarray,
) -> None:
    """Write the joint's motion and the weights (T, M) of every frame."""
    animation = UsdSkel.Animation.Define(made, MOTION)
    animation.CreateJointsAttr(Vt.TokenArray([JOINT]))
    animation.CreateBlendShapesAttr(Vt.TokenArray(prims))
    animation.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1.0)]))
    turns, moves = animation.CreateRotationsAttr(), animation.CreateTranslationsAttr()
    curves = animation.CreateBlendShapeWeightsAttr()
    places = pivot + motion.translation / motion.scale[:, None]
    for row, number in enumerate(map(float, frame)):
        x, y, z, w = map(float, motion.rotation[row])
        turns.Set(Vt.QuatfArray([Gf.Quatf(w, x, y, z)]), number)
        moves.Set(usd.vectors(places[row : row + 1]), number)
        curves.Set(Vt.FloatArray.FromNumpy(weights[row].astype(np.float32)), number)
