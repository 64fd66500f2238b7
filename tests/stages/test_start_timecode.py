"""Every output that has a place for it carries rate, first frame and its timecode."""

import json
from fractions import Fraction

import pygltflib
import pytest
from played_take import PlayedTake
from pxr import Usd

from bench import formats
from stages import export_maya
from stages.files import series

RATE = Fraction(30000, 1001)
# 107 frames are 3 seconds and 17; drop-frame leaves no number out before the first minute
FIRST, STARTS, WANTED = 107, "10:00:00;00", "10:00:03;17"


@pytest.fixture(scope="module", params=[STARTS, ""])
def made(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("take")
    take = PlayedTake(folder, "y", RATE, FIRST, 5)
    read = series.read(folder / "weights.parquet", "weights")
    more = {"start_timecode": request.param, "timecode_rate": "30000/1001"}
    meta = read.meta | (more if request.param else {})
    series.write(
        folder / "weights.parquet",
        "weights",
        read.frame,
        read.time_s,
        read.columns,
        RATE,
        {key: value for key, value in meta.items() if key not in {"kind", "layout_version"}},
    )
    formats.write(folder, folder / "rig.npz", folder / "weights.parquet")
    script = [*take.options("rig", "weights", script="maya.py", anim="maya.anim"), "--template"]
    export_maya.main([*script, str(formats.TEMPLATES / "apply_in_maya.py")])
    return folder, WANTED if request.param else None


def script_take(path):
    line = next(line for line in path.read_text().splitlines() if line.startswith("TAKE = "))
    return json.loads(line.removeprefix('TAKE = json.loads(r"""').removesuffix('""")'))


def usd_take(path):
    stage = Usd.Stage.Open(str(path))
    assert stage.GetStartTimeCode() == FIRST
    assert stage.GetTimeCodesPerSecond() == pytest.approx(float(RATE))
    return stage.GetRootLayer().customLayerData["keyface"]


def glb_take(path):
    return pygltflib.GLTF2().load(str(path)).animations[0].extras


def json_take(path):
    document = json.loads(path.read_text())
    return document.get("keyface", document)


READERS = {
    "mesh.json": json_take,
    "mesh.glb": glb_take,
    "mesh.usdc": usd_take,
    "points.usdc": usd_take,
    "obj/take.json": json_take,
    "half/texture.json": json_take,
    "openvat/texture.json": json_take,
    "blender.py": script_take,
    "maya.py": script_take,
}


@pytest.mark.parametrize("name", READERS)
def test_it_is_there_where_it_is_known(made, name):
    folder, wanted = made
    said = READERS[name](folder / name)
    assert Fraction(said["fps_num"], said["fps_den"]) == RATE
    assert said["first_frame"] == FIRST
    assert said.get("start_timecode") == wanted
