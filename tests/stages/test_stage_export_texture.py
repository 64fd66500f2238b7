"""Textures, looked up as a material does, by a decoder of EXR that is not the library's."""

import json

import numpy as np
import pytest
import trimesh
from played_take import RATES, PlayedTake

from bench import exr_reader, glb_against_exr, texture_reader
from stages import export_texture
from stages.files import errors, exr


def export(take, layout="plain", **more):
    names = {"texture": "texture.exr", "normals": "texture_normals.exr"}
    names |= {"texture_json": "texture.json", "texture_mesh": "texture_mesh.obj"}
    words = [word for name, value in more.items() for word in (f"--{name}", value)]
    options = take.options("exr", "json", "rig", **names)
    export_texture.main([*options, "--layout", layout, *words])
    return take


def said_of(take):
    document = json.loads((take.folder / "texture.json").read_text())
    return document.get("keyface", document)


def y_up(take, rows):
    return rows @ take.axes


def true_normals(take, points):
    """Return normals at the vertices, weighted by the areas of trimesh."""
    triangles = [face[corner] for face in take.faces for corner in (0, 1, 2, 0, 2, 3)]
    mesh = trimesh.Trimesh(points, np.reshape(triangles, (-1, 3)), process=False)
    total = np.zeros((len(points), 3))
    np.add.at(total, mesh.faces, (mesh.face_normals * mesh.area_faces[:, None])[:, None])
    return total / np.linalg.norm(total, axis=1, keepdims=True)


@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("depth", ["half", "float"])
@pytest.mark.parametrize("scaling", ["per_axis", "max_deviation"])
def test_the_plain_texture_moves_the_mesh_within_the_stated_error(tmp_path, up, depth, scaling):
    take = export(PlayedTake(tmp_path, up, first=3).bake(), depth=depth, scaling=scaling)
    times, found, normals = texture_reader.plain(tmp_path)
    wanted, said = take.positions(), said_of(take)
    off = np.abs(found - wanted).max(axis=(0, 1))
    assert (off <= said["quantisation"]["max_error"]).all()
    # the bound is tight: no more than a few times what is found
    assert (off > 0.1 * np.array(said["quantisation"]["max_error"])).all() or depth == "float"
    assert take.worst(found) < (1e-6 if depth == "float" else 1e-3)
    assert np.linalg.norm(found - wanted, axis=2).max() <= said["quantisation"]["max_distance"]
    moved = wanted - take.neutral
    np.testing.assert_allclose(said["bounds"]["min"], moved.min(axis=(0, 1)), atol=1e-5)
    np.testing.assert_allclose(said["bounds"]["max"], moved.max(axis=(0, 1)), atol=1e-5)
    np.testing.assert_allclose(times, (3 + np.arange(take.count)) / 30)
    assert said["axes"]["up"] == up and said["unit"] == "cm"
    for turned, points in zip(normals, wanted, strict=True):
        np.testing.assert_allclose(turned, true_normals(take, points), atol=2e-3)


@pytest.mark.parametrize("up", ["y", "z"])
def test_openvats_layout_moves_its_mesh_upright(tmp_path, up):
    take = export(PlayedTake(tmp_path, up).bake(), "openvat")
    times, found, _ = texture_reader.openvat(tmp_path)
    wanted = y_up(take, take.positions())
    off = np.linalg.norm(found - wanted, axis=2).max()
    assert off <= said_of(take)["quantisation"]["max_distance"]
    vertices, _ = texture_reader.mesh(tmp_path / "texture_mesh.obj")
    np.testing.assert_allclose(vertices, y_up(take, take.neutral), atol=1e-6)
    pixels = exr_reader.read(tmp_path / "texture.exr")
    assert pixels.shape[:2] == (64, 64)
    assert pixels.min() == 0 and pixels.max() == 1
    document = json.loads((tmp_path / "texture.json").read_text())
    assert set(document["os-remap"]) == {"Min", "Max", "Frames"}
    assert document["os-remap"]["Frames"] == take.count == len(times)


def test_many_vertices_are_wrapped(tmp_path, monkeypatch):
    take = PlayedTake(tmp_path).bake()
    monkeypatch.setattr(exr, "layout", lambda vertices: (40, 3))
    export(take, depth="float")
    assert said_of(take)["height"] == 3 * take.count
    _, found, _ = texture_reader.plain(tmp_path)
    assert take.worst(found) < 1e-6


def test_numbers_are_half_or_float_and_two_readers_agree(tmp_path):
    take = PlayedTake(tmp_path, count=20).bake()
    np.testing.assert_array_equal(
        exr_reader.read(tmp_path / "mesh.exr").reshape(20, -1, 3),
        glb_against_exr.baked(tmp_path)[0],
    )
    sizes = []
    for depth in ("half", "float"):
        export(take, depth=depth)
        sizes.append((tmp_path / "texture.exr").stat().st_size)
    assert sizes[0] < 0.7 * sizes[1]


@pytest.mark.parametrize("layout", ["plain", "openvat"])
@pytest.mark.parametrize("rate", RATES, ids=str)
def test_every_rate_keeps_its_frames_and_its_last_time(tmp_path, layout, rate):
    take = export(PlayedTake(tmp_path, rate=rate, first=999, count=4).bake(), layout)
    times, found, _ = getattr(texture_reader, layout)(tmp_path)
    assert len(found) == 4
    assert times[-1] == take.last_time
    assert (
        said_of(take)["vertex_hash"]
        == json.loads((tmp_path / "mesh.json").read_text())["vertex_hash"]
    )


def test_bytes_are_the_same_again(tmp_path):
    take = export(PlayedTake(tmp_path, count=5).bake())
    before = {path.name: path.read_bytes() for path in tmp_path.glob("texture*")}
    assert len(before) == 4
    export(take)
    assert before == {path.name: path.read_bytes() for path in tmp_path.glob("texture*")}


def test_what_does_not_fit_is_refused_and_nothing_is_left(tmp_path):
    take = PlayedTake(tmp_path, count=2).bake()
    with pytest.raises(errors.InputError, match="openvat scales each axis"):
        export(take, "openvat", scaling="max_deviation")
    path = tmp_path / "mesh.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"vertex_hash": "0"}))
    with pytest.raises(errors.InputError, match="baked from another rig"):
        export(take)
    assert not list(tmp_path.glob("*texture*"))
