"""OBJ sequences, read by trimesh and, for polygons, line by line."""

import json

import numpy as np
import pytest
import trimesh
from played_take import RATES, PlayedTake

from stages import export_obj
from stages.files import errors


def export(take):
    export_obj.main(take.options("exr", "json", "rig", obj_folder="obj"))
    return sorted((take.folder / "obj").glob("*.obj"))


@pytest.mark.parametrize("up", ["y", "z"])
def test_every_file_is_a_frame_of_the_contract(tmp_path, up):
    take = PlayedTake(tmp_path, up, first=95).bake()
    paths = export(take)
    assert [path.name for path in paths] == [f"frame_{95 + f:04d}.obj" for f in range(take.count)]
    found = [trimesh.load(path, process=False, maintain_order=True).vertices for path in paths]
    assert take.worst(found) < 1e-6


def test_names_sort_as_their_frames(tmp_path):
    paths = export(PlayedTake(tmp_path, first=9_999, count=2).bake())
    assert [path.name for path in paths] == ["frame_09999.obj", "frame_10000.obj"]


def test_polygons_are_the_characters_own(tmp_path):
    take = PlayedTake(tmp_path, count=1).bake()
    lines = export(take)[0].read_text().splitlines()
    assert lines[0] == "# frame 0, cm, y up"
    faces = [[int(word) - 1 for word in line.split()[1:]] for line in lines if line[0] == "f"]
    np.testing.assert_array_equal(faces, take.faces)
    assert sum(line[0] == "v" for line in lines) == len(take.neutral)


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_the_folder_says_rate_start_and_hash(tmp_path, rate):
    take = PlayedTake(tmp_path, rate=rate, first=12_345, count=3).bake()
    assert [path.stem for path in export(take)] == [f"frame_{12_345 + f}" for f in range(3)]
    said = json.loads((tmp_path / "obj" / "take.json").read_text())
    baked = json.loads((tmp_path / "mesh.json").read_text())
    for name in ("fps_num", "fps_den", "first_frame", "frames", "unit", "vertex_hash"):
        assert said[name] == baked[name]
    last = (said["first_frame"] + said["frames"] - 1) * said["fps_den"] / said["fps_num"]
    assert last == take.last_time
    assert said["up_axis"] == "y" and said["metres_per_unit"] == 0.01


def test_another_rig_is_refused_and_nothing_is_left(tmp_path):
    take = PlayedTake(tmp_path, count=2).bake()
    path = tmp_path / "mesh.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"vertex_hash": "0"}))
    with pytest.raises(errors.InputError, match="baked from another rig"):
        export(take)
    assert not list(tmp_path.glob("*obj*"))
