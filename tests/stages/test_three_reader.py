"""Three.js plays the GLB, where it is to be had: KEYFACE_THREE names its folder.

Without it, the page's other side is played by a stand-in for the browser.
"""

import os
import shutil
import stat
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from played_take import PlayedTake

from bench import three_reader

THREE = os.environ.get("KEYFACE_THREE")
BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
STAND_IN = """#!{python}
import json, sys, urllib.request
def ask(where, body=None):
    return urllib.request.urlopen(sys.argv[-1].rstrip("/") + where, body).read()
{script}
"""


@pytest.fixture
def three(tmp_path):
    folder = tmp_path / "three" / "build"
    folder.mkdir(parents=True)
    (folder / "three.module.js").write_text("export const REVISION = 'none';")
    return folder.parent


def stand_in(folder, script):
    path = folder / "browser"
    path.write_text(STAND_IN.format(python=sys.executable, script=script))
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


@pytest.mark.skipif(not (THREE and BROWSER), reason="needs three.js and Chromium")
@pytest.mark.parametrize("up", ["y", "z"])
def test_three_puts_every_vertex_where_the_contract_says(tmp_path, up):
    take = PlayedTake(tmp_path, up, Fraction(24000, 1001), 11, 9, 2.0).bake()
    times = np.arange(11, 20) * 1001 / 24000
    played = three_reader.play(tmp_path / "mesh.glb", Path(THREE), BROWSER, times)
    np.testing.assert_allclose(played.times, times, rtol=1e-6)
    upright = {"y": np.eye(3), "z": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])}[up]
    size = np.linalg.norm(np.ptp(played.positions.reshape(-1, 3), axis=0))
    wanted = take.positions() @ upright.T
    metres = size / np.linalg.norm(np.ptp(wanted.reshape(-1, 3), axis=0))
    assert min(abs(metres - unit) for unit in (1, 0.01, 0.001)) < 1e-6
    assert take.worst(played.positions / metres @ upright) < 1e-6


def test_frames_come_back_as_the_page_sends_them(tmp_path, three):
    (tmp_path / "mesh.glb").write_bytes(b"glb")
    script = """
import array
assert ask("/mesh.glb") == b"glb" and b"REVISION" in ask("/three/build/three.module.js")
assert b"GLTFLoader" in ask("/")
times = json.loads(ask("/times.json"))
for time in times:
    ask("/frame", array.array("d", [time, 1, 2, 3, 4, 5]).tobytes())
ask("/played", json.dumps({"times": times, "revision": "none"}).encode())
"""
    played = three_reader.play(
        tmp_path / "mesh.glb", three, stand_in(tmp_path, script), np.array([0.5, 0.75])
    )
    np.testing.assert_array_equal(played.times, [0.5, 0.75])
    np.testing.assert_array_equal(played.positions[:, 1], [[3, 4, 5]] * 2)
    np.testing.assert_array_equal(played.positions[:, 0, 0], [0.5, 0.75])


def test_a_page_that_fails_and_files_that_are_none_of_its_business(tmp_path, three):
    (tmp_path / "mesh.glb").write_bytes(b"glb")
    script = """
try:
    ask("/three/../mesh.glb")
    ask("/failed", b"read it")
except urllib.error.HTTPError as error:
    ask("/failed", str(error.code).encode())
"""
    browser = stand_in(tmp_path, script)
    with pytest.raises(RuntimeError, match=r"three\.js: 404"):
        three_reader.play(tmp_path / "mesh.glb", three, browser, np.zeros(1))
    with pytest.raises(RuntimeError, match="is not the folder of three.js"):
        three_reader.play(tmp_path / "mesh.glb", tmp_path, browser, np.zeros(1))
