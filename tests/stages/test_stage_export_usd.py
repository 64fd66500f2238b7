"""USD, evaluated by UsdSkel of the pxr library."""

import json
from fractions import Fraction

import numpy as np
import pytest
from played_take import FRAMES, RATES, PlayedTake
from pxr import Usd, UsdGeom, UsdSkel

from bench import usd_reader
from stages import export_usd
from stages.files import errors, usd


def export(take, kind="usdc"):
    export_usd.main(take.options("rig", "weights", usd=f"mesh.{kind}", points=f"points.{kind}"))
    return take


@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("spread", [1.0, 3.0])
@pytest.mark.parametrize("kind", ["usda", "usdc"])
def test_both_files_move_the_vertices_by_the_contract(tmp_path, up, spread, kind):
    take = export(PlayedTake(tmp_path, up, first=5, spread=spread), kind)
    _, found = usd_reader.skinned(tmp_path / f"mesh.{kind}")
    assert take.worst(found) < 1e-6
    _, points = usd_reader.sampled(tmp_path / f"points.{kind}")
    assert take.worst(points) < 1e-6
    stage = Usd.Stage.Open(str(tmp_path / f"mesh.{kind}"))
    assert UsdGeom.GetStageUpAxis(stage) == up.upper()
    assert UsdGeom.GetStageMetersPerUnit(stage) == 0.01


def test_every_reader_finds_what_it_demands(tmp_path):
    take = export(PlayedTake(tmp_path, spread=3.0))
    stage = Usd.Stage.Open(str(tmp_path / "mesh.usdc"))
    kinds = {prim.GetTypeName() for prim in stage.Traverse()}
    assert kinds == {"Xform", "SkelRoot", "Skeleton", "SkelAnimation", "Mesh", "BlendShape"}
    face = stage.GetPrimAtPath("/character/rig/face")
    assert face.HasAPI(UsdSkel.BindingAPI)
    binding = UsdSkel.BindingAPI(face)
    names = binding.GetBlendShapesAttr().Get()
    targets = binding.GetBlendShapeTargetsRel().GetTargets()
    assert [path.name for path in targets] == list(names)
    assert not binding.GetBlendShapesAttr().GetTimeSamples()
    animation = UsdSkel.Animation(stage.GetPrimAtPath("/character/rig/motion"))
    assert animation.GetBlendShapesAttr().Get() == names
    curves = animation.GetBlendShapeWeightsAttr()
    weights = np.array([curves.Get(number) for number in curves.GetTimeSamples()])
    assert weights.shape == (FRAMES, len(names)) and weights.min() >= 0 and weights.max() <= 1
    assert any(name.endswith("_minus") for name in names)
    data = stage.GetPrimAtPath(targets[0]).GetCustomDataByKey("keyface")
    column = take.played[data["name"]]
    np.testing.assert_allclose(weights[:, 0] * data["gain"], np.maximum(column, 0), rtol=1e-5)
    shape = UsdSkel.BlendShape(stage.GetPrimAtPath(targets[0]))
    moved = shape.GetPointIndicesAttr().Get()
    assert 0 < len(moved) < len(take.neutral) and len(moved) == len(shape.GetOffsetsAttr().Get())
    mesh = UsdGeom.Mesh(face)
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none"
    counts, corners = mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get()
    assert list(counts) == [4] * len(take.faces)
    np.testing.assert_array_equal(corners, np.ravel(take.faces))
    assert len(UsdGeom.Gprim(face).GetDisplayColorAttr().Get()) == len(take.neutral)


@pytest.mark.parametrize("name", ["mesh.usdc", "points.usdc"])
def test_extents_hold_the_moving_points_and_no_more(tmp_path, name):
    take = export(PlayedTake(tmp_path))
    stage = Usd.Stage.Open(str(tmp_path / name))
    path = "/character/rig" if name == "mesh.usdc" else "/character/face"
    prim = stage.GetPrimAtPath(path)
    for number, points in enumerate(take.positions()):
        box = UsdGeom.Boundable(prim).GetExtentAttr().Get(number)
        box = usd_reader.in_world(prim, box, number)
        np.testing.assert_allclose(box, [points.min(axis=0), points.max(axis=0)], atol=1e-4)


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_every_rate_keeps_its_frames_and_its_last_time(tmp_path, rate):
    take = export(PlayedTake(tmp_path, rate=rate, first=86_400, count=6))
    for name, read in (("mesh.usdc", usd_reader.skinned), ("points.usdc", usd_reader.sampled)):
        times, _ = read(tmp_path / name)
        np.testing.assert_array_equal(np.rint(times * float(rate)), 86_400 + np.arange(6))
        assert times[-1] == pytest.approx(take.last_time, abs=1e-9)
        stage = Usd.Stage.Open(str(tmp_path / name))
        assert stage.GetFramesPerSecond() == stage.GetTimeCodesPerSecond() == float(rate)
        clock = stage.GetRootLayer().customLayerData["keyface"]
        assert Fraction(clock["fps_num"], clock["fps_den"]) == rate
        assert (clock["first_frame"], clock["frames"]) == (86_400, 6)


def test_the_hash_is_that_of_the_other_outputs_and_bytes_are_the_same_again(tmp_path):
    take = export(PlayedTake(tmp_path, count=70).bake())
    names = ("mesh.usdc", "points.usdc")
    before = [(tmp_path / name).read_bytes() for name in names]
    stage = Usd.Stage.Open(str(tmp_path / "mesh.usdc"))
    data = stage.GetRootLayer().customLayerData["keyface"]
    assert data["vertex_hash"] == json.loads((tmp_path / "mesh.json").read_text())["vertex_hash"]
    export(take)
    assert [(tmp_path / name).read_bytes() for name in names] == before


def test_a_head_that_keeps_its_size_has_no_scale(tmp_path):
    take = export(PlayedTake(tmp_path, count=4, scaled=False))
    _, found = usd_reader.skinned(tmp_path / "mesh.usdc")
    assert take.worst(found) < 1e-6
    stage = Usd.Stage.Open(str(tmp_path / "mesh.usdc"))
    root = UsdGeom.Xformable(stage.GetPrimAtPath("/character"))
    assert not root.GetOrderedXformOps()


def test_prim_names_are_allowed_and_different():
    found = usd.prim_names(["a.b", "a_b", "1.b", "a.b_2", "a.b"])
    assert found == ["a_b", "a_b_2", "__b", "a_b_2_2", "a_b_3"]


def test_another_ending_is_refused_and_nothing_is_left(tmp_path):
    take = PlayedTake(tmp_path, count=1)
    with pytest.raises(errors.InputError, match=r"'\.abc' is none of \.usd, \.usda, \.usdc"):
        export(take, "abc")
    assert not list(tmp_path.glob("*mesh*")) and not list(tmp_path.glob("*points*"))
