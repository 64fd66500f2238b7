"""A glTF with few morph targets at once says how wrong it is, and is wrong by no more."""

import json
import logging

import numpy as np
import pytest
from played_take import RATES, PlayedTake

from bench import glb_against_exr
from stages.files import errors


def test_the_stated_error_is_what_a_reader_finds(tmp_path, caplog):
    caplog.set_level(logging.INFO)
    take = PlayedTake(tmp_path, spread=2.0).bake("--most-targets", "3")
    layout = json.loads((tmp_path / "mesh.json").read_text())["glb_pruning"]
    assert layout["most_targets"] == 3
    found = glb_against_exr.greatest_difference(tmp_path)
    assert found == pytest.approx(layout["max_error_of_size"], rel=1e-4)
    assert found > 1e-3
    assert f"worst error {layout['max_error_of_size']:.3g} of the size" in caplog.text
    glb = glb_against_exr.Glb(tmp_path / "mesh.glb")
    _, keys = glb.curves()
    active = keys[2, "weights"] > 0
    assert ((active[:-1] | active[1:]).sum(axis=1) <= 3).all()
    take.bake()
    assert "glb_pruning" not in json.loads((tmp_path / "mesh.json").read_text())
    assert glb_against_exr.greatest_difference(tmp_path) < 1e-6


def test_a_negative_number_is_refused(tmp_path):
    with pytest.raises(errors.InputError, match="-1 is negative"):
        PlayedTake(tmp_path, count=1).bake("--most-targets", "-1")


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_the_glb_carries_rate_and_first_frame_and_keeps_every_time(tmp_path, rate):
    take = PlayedTake(tmp_path, rate=rate, first=7, count=5).bake()
    glb = glb_against_exr.Glb(tmp_path / "mesh.glb")
    times, _ = glb.curves()
    np.testing.assert_array_equal(np.rint(times * float(rate)), 7 + np.arange(5))
    clock = glb.document["animations"][0]["extras"]
    assert clock == {
        "fps_num": rate.numerator,
        "fps_den": rate.denominator,
        "first_frame": 7,
        "frames": 5,
    }
    assert times[-1] == pytest.approx(take.last_time, rel=1e-7)
