"""Evaluate USD files with the library's own skinning, frame by frame."""

from pathlib import Path

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel, Vt


def times(stage: Usd.Stage) -> np.ndarray:
    """Return the times of the frames from start to end [s]."""
    codes = range(round(stage.GetStartTimeCode()), round(stage.GetEndTimeCode()) + 1)
    return np.array([code / stage.GetTimeCodesPerSecond() for code in codes])


def first(stage: Usd.Stage, kind: type) -> Usd.Prim:
    """Return the first prim of a kind."""
    return next(prim for prim in stage.Traverse() if prim.IsA(kind))


def in_world(prim: Usd.Prim, points: Vt.Vec3fArray, code: float) -> np.ndarray:
    """Bring points (V, 3) of a prim into the world at a time code."""
    matrix = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(code))
    return np.array(points, float) @ matrix[:3, :3] + matrix[3, :3]


def sampled(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the times (T,) and the points (T, V, 3) of the one mesh."""
    stage = Usd.Stage.Open(str(path))
    mesh = first(stage, UsdGeom.Mesh)
    points = UsdGeom.Mesh(mesh).GetPointsAttr()
    codes = points.GetTimeSamples()
    found = [in_world(mesh, points.Get(code), code) for code in codes]
    return np.array(codes) / stage.GetTimeCodesPerSecond(), np.array(found)


def skinned(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the times (T,) and the points (T, V, 3) of the one skinned mesh."""
    stage = Usd.Stage.Open(str(path))
    cache = UsdSkel.Cache()
    cache.Populate(UsdSkel.Root(first(stage, UsdSkel.Root)), Usd.PrimDefaultPredicate)
    skeleton = cache.GetSkelQuery(UsdSkel.Skeleton(first(stage, UsdSkel.Skeleton)))
    face = first(stage, UsdGeom.Mesh)
    skinning = cache.GetSkinningQuery(face)
    shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(face))
    places, offsets = shapes.ComputeBlendShapePointIndices(), shapes.ComputeSubShapePointOffsets()
    found = []
    for code in range(round(stage.GetStartTimeCode()), round(stage.GetEndTimeCode()) + 1):
        weights = skeleton.GetAnimQuery().ComputeBlendShapeWeights(code)
        mapper = skinning.GetBlendShapeMapper()
        weights = weights if mapper.IsIdentity() else mapper.Remap(weights)
        points = Vt.Vec3fArray(UsdGeom.Mesh(face).GetPointsAttr().Get())
        parts = shapes.ComputeSubShapeWeights(weights)
        shapes.ComputeDeformedPoints(*parts, places, offsets, points)
        skinning.ComputeSkinnedPoints(skeleton.ComputeSkinningTransforms(code), points, code)
        found.append(in_world(face, points, code))
    return times(stage), np.array(found)
