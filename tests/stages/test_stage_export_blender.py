"""Blender's script, run against stand-ins; `python -m bench.formats --blender` runs Blender."""

import runpy
import sys
from pathlib import Path

import fake_blender
import numpy as np
import pytest
from played_take import RATES, PlayedTake
from scipy.spatial.transform import Rotation

from stages import export_blender

TEMPLATE = Path(export_blender.__file__).parent / "templates" / "apply_in_blender.py"
REST = np.array([[0, 0, 2.0, 5], [2, 0, 0, 6], [0, 2, 0, 7], [0, 0, 0, 1]])


def export(take):
    options = take.options("rig", "weights", script="blender.py")
    export_blender.main([*options, "--template", str(TEMPLATE)])
    return take


def run(take, mesh, monkeypatch, name="taken"):
    """Run the script as Blender would; return the scene and what the script defines."""
    made = fake_blender.modules(mesh)
    for module, stand_in in made.items():
        monkeypatch.setitem(sys.modules, module, stand_in)
    return made["bpy"].context.scene, runpy.run_path(str(take.folder / "blender.py"), run_name=name)


def curve(mesh, key, frames):
    return mesh.keys.at(f'key_blocks["{key}"].value', frames)


@pytest.mark.parametrize("slotted", [True, False])
@pytest.mark.parametrize("rate", RATES, ids=str)
def test_the_script_sets_every_frame_and_the_scenes_clock(tmp_path, monkeypatch, rate, slotted):
    take = export(PlayedTake(tmp_path, rate=rate, first=9, spread=3.0))
    mesh = fake_blender.Mesh(list(take.played)[::-1], slotted, np.eye(4))
    scene, _ = run(take, mesh, monkeypatch, "__main__")
    frames = 9 + np.arange(take.count)
    for name, values in take.played.items():
        np.testing.assert_allclose(curve(mesh, name, frames), values, atol=1e-7)
    for key in mesh.keys.key_blocks:
        assert key.slider_min == min(0, take.played[key.name].min())
        assert key.slider_max == max(1, take.played[key.name].max())
    assert any(key.slider_max > 1 for key in mesh.keys.key_blocks)
    assert any(key.slider_min < 0 for key in mesh.keys.key_blocks)
    assert (scene.frame_start, scene.frame_end) == (9, 9 + take.count - 1)
    base = np.float32(scene.render.fps_base)
    assert isinstance(scene.render.fps, int)
    last = scene.frame_end * float(base) / scene.render.fps
    assert last == pytest.approx(take.last_time, rel=1e-7)


@pytest.mark.parametrize("up", ["y", "z"])
def test_shapes_and_head_give_the_contract_on_top_of_the_rest(tmp_path, monkeypatch, up):
    take = export(PlayedTake(tmp_path, up))
    mesh = fake_blender.Mesh(list(take.played), True, REST)
    _, made = run(take, mesh, monkeypatch)
    frames = np.arange(take.count)
    # a second time changes nothing: the rest is kept
    for _ in range(2):
        made["apply"]()
        place, turn, size = (
            np.stack([mesh.at(path, frames, index) for index in range(count)], axis=1)
            for path, count in (("location", 3), ("rotation_quaternion", 4), ("scale", 3))
        )
        mesh.matrix_basis = fake_blender.Matrix(np.eye(4))
        still = take.positions_without_head()
        turns = Rotation.from_quat(np.roll(turn, -1, axis=1)).as_matrix()
        found = np.einsum("tij,tvj->tvi", turns, size[:, None] * still) + place[:, None]
        back = (found - REST[:3, 3]) @ np.linalg.inv(REST[:3, :3]).T
        assert take.worst(back) < 1e-6
        assert (np.sum(turn[1:] * turn[:-1], axis=1) > 0).all()
    assert mesh.rotation_mode == "QUATERNION"


def test_shape_keys_by_other_spellings_and_those_that_lack(tmp_path, monkeypatch, capsys):
    take = export(PlayedTake(tmp_path))
    mesh = fake_blender.Mesh(["Basis", "ROM_F0003", "Mouth_rom_f0040"], True, np.eye(4))
    missing = run(take, mesh, monkeypatch)[1]["apply"](head=False)
    assert missing == ["mouth.rom_f0041", "eyes.rom_f0011", "eyes.rom_f0012"]
    assert "face has no shape key for: mouth.rom_f0041" in capsys.readouterr().out
    np.testing.assert_allclose(
        curve(mesh, "Mouth_rom_f0040", np.arange(take.count)),
        take.played["mouth.rom_f0040"],
        atol=1e-7,
    )
    assert not mesh.curves


def test_a_point_cache_is_loaded_as_it_stands(tmp_path, monkeypatch):
    take = export(PlayedTake(tmp_path, first=3, count=2))
    mesh = fake_blender.Mesh([], True, np.eye(4))
    _, made = run(take, mesh, monkeypatch)
    for path, kind in (("/x/mesh.pc2", "PC2"), ("/x/mesh.MDD", "MDD")):
        modifier = made["apply_points"](path)
        assert (modifier.kind, modifier.cache_format) == ("MESH_CACHE", kind)
        assert (modifier.forward_axis, modifier.up_axis) == ("POS_Y", "POS_Z")
        assert modifier.frame_start == 3
    assert len(mesh.modifiers) == 1


def test_no_mesh_or_no_shape_keys_is_said(tmp_path, monkeypatch):
    take = export(PlayedTake(tmp_path, count=1))
    with pytest.raises(RuntimeError, match="Select the mesh first"):
        run(take, None, monkeypatch, "__main__")
    bare = fake_blender.Mesh([], True, np.eye(4))
    with pytest.raises(RuntimeError, match="face has no shape keys"):
        run(take, bare, monkeypatch, "__main__")
