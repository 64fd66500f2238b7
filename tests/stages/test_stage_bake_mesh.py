import json

import numpy as np
import pytest
import scipy.spatial.transform
from small_take import FRAMES, REGIONS, SmallTake

from bench import glb_against_exr
from stages import assemble_rig, bake_mesh, smooth_weights
from stages.files import errors, weights


@pytest.fixture(scope="module", params=["y", "z"])
def take(request, tmp_path_factory):
    made = SmallTake(tmp_path_factory.mktemp("take"), up=request.param)
    assemble_rig.main(made.rig_options())
    smooth_weights.main(made.weights_options())
    bake_mesh.main(made.bake_options())
    return made


def contract(take):
    """Move the character by the written formula, in float64 loops over what was put in."""
    ramp = np.clip((take.heights + 0.2) / 0.5, 0, 1)
    masks = {"mouth": 1 - ramp, "eyes": ramp}
    pivot = np.array([1.0, -8.0, 0.5])
    frames = []
    for frame in range(FRAMES):
        points = take.neutral.copy()
        for region, names in REGIONS.items():
            for name in names:
                weight = take.weights[f"{region}.{name}"][frame]
                points += masks[region][:, None] * weight * take.deltas[region, name]
        turn = scipy.spatial.transform.Rotation.from_quat(take.turns[frame]).as_matrix()
        turn = take.axes @ turn @ take.axes.T
        shift = 6.5 * take.axes @ take.shift[frame]
        frames.append(pivot + take.scale[frame] * (points - pivot) @ turn.T + shift)
    return np.array(frames)


def test_the_bake_is_the_contract(take):
    baked, _ = glb_against_exr.baked(take.folder)
    np.testing.assert_allclose(baked, contract(take), atol=2e-5)


def test_the_point_cache_holds_the_same_bytes(take):
    baked, _ = glb_against_exr.baked(take.folder)
    data = (take.folder / "mesh.pc2").read_bytes()[32:]
    np.testing.assert_array_equal(np.frombuffer(data, "<f4").reshape(baked.shape), baked)


def test_the_glb_evaluates_to_the_baked_vertices_upright_and_in_metres(take):
    assert glb_against_exr.greatest_difference(take.folder) < 1e-6
    glb = glb_against_exr.Glb(take.folder / "mesh.glb")
    _, keys = glb.curves()
    points = glb.positions(0, keys)
    assert np.corrcoef(points[:, 1], take.heights)[0, 1] > 0.95
    assert 0.15 < np.ptp(points[:, 1]) < 0.4


def test_the_glb_is_what_viewers_ask_for(take):
    glb = glb_against_exr.Glb(take.folder / "mesh.glb")
    mesh = glb.document["meshes"][0]
    primitive = mesh["primitives"][0]
    names = mesh["extras"]["targetNames"]
    assert names == [f"{region}.{name}" for region, row in REGIONS.items() for name in row]
    assert len(mesh["weights"]) == len(primitive["targets"]) == len(names)
    triangles = glb.accessor(primitive["indices"]).astype(int).reshape(-1, 3)
    assert len(triangles) == 2 * len(take.faces)
    np.testing.assert_array_equal(
        triangles[:2], [take.faces[0][:3], np.take(take.faces[0], [0, 2, 3])]
    )
    positions = glb.accessor(primitive["attributes"]["POSITION"])
    np.testing.assert_allclose(positions, take.neutral, atol=1e-5)
    normals = glb.accessor(primitive["attributes"]["NORMAL"])
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
    assert glb.accessor(primitive["attributes"]["COLOR_0"]).shape == positions.shape
    for number, entry in enumerate(glb.document["accessors"]):
        values = glb.accessor(number)
        if "min" in entry:
            np.testing.assert_allclose(entry["min"], values.min(axis=0), atol=1e-7)
            np.testing.assert_allclose(entry["max"], values.max(axis=0), atol=1e-7)
        # the specification forbids an offset into a view that is not there
        assert "bufferView" in entry or "byteOffset" not in entry
    for view in glb.document["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
    assert all("sparse" in glb.document["accessors"][t["POSITION"]] for t in primitive["targets"])


def test_the_json_counts_the_targets_that_are_active_at_once(take):
    layout = json.loads((take.folder / "mesh.json").read_text())
    assert layout["morph_targets_active_at_once"] == 5
    assert layout["axes"]["up"] == take.up
    assert layout["metres_per_unit"] == 0.01


def test_baking_twice_gives_the_same_bytes(take):
    names = [f"mesh.{kind}" for kind in ("exr", "json", "pc2", "glb")]
    before = [(take.folder / name).read_bytes() for name in names]
    bake_mesh.main(take.bake_options())
    assert [(take.folder / name).read_bytes() for name in names] == before


def test_weights_of_other_shapes_leave_nothing_half_written(tmp_path):
    take = SmallTake(tmp_path)
    assemble_rig.main(take.rig_options())
    smooth_weights.main(take.weights_options())
    read = weights.read(tmp_path / "weights.parquet", ["mouth.rom_f0003"])
    columns = {"mouth.rom_f0003": read.shapes[:, 0], "confidence": read.confidence}
    columns |= weights.head_columns(read.rotation, np.c_[read.translation, read.scale])
    weights.write(tmp_path / "weights.parquet", tmp_path / "w.csv", read.frame, columns, read.rate)
    with pytest.raises(errors.InputError, match=r"column mouth\.rom_f0040 is missing"):
        bake_mesh.main(take.bake_options())
    assert not list(tmp_path.glob("*mesh*"))
