"""MDD, read by its specification with `struct`."""

import json
import struct

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from played_take import RATES, PlayedTake

from stages import export_mdd
from stages.files import errors, mdd


def read(path):
    """Return the times and positions of an MDD file."""
    data = path.read_bytes()
    frames, points = struct.unpack(">ii", data[:8])
    assert len(data) == 8 + 4 * frames + 12 * frames * points
    times = np.frombuffer(data, ">f4", frames, 8)
    places = np.frombuffer(data, ">f4", 3 * frames * points, 8 + 4 * frames)
    return times.astype(float), places.reshape(frames, points, 3).astype(float)


@pytest.mark.parametrize("up", ["y", "z"])
def test_the_cache_moves_the_vertices_by_the_contract(tmp_path, up):
    take = PlayedTake(tmp_path, up, first=12).bake()
    export_mdd.main(take.options("exr", "json", mdd="mesh.mdd"))
    times, found = read(tmp_path / "mesh.mdd")
    assert take.worst(found) < 1e-6
    np.testing.assert_allclose(times, (12 + np.arange(take.count)) / 30, rtol=1e-7)


@settings(
    deadline=None, max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.sampled_from(RATES), st.integers(0, 200_000), st.integers(1, 50))
def test_every_rate_keeps_its_frames_and_its_times_to_the_tick(tmp_path, rate, first, count):
    numbers = first + np.arange(count)
    with mdd.writer(tmp_path / "m.mdd", 2, numbers * rate.denominator / rate.numerator) as append:
        for _ in range(count):
            append(np.zeros((2, 3)))
    times, _ = read(tmp_path / "m.mdd")
    np.testing.assert_array_equal(np.rint(times * float(rate)), numbers)


def spoil(take, **changed):
    path = take.folder / "mesh.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changed))


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"frames": 10**9}, "in place of what its JSON says"),
        ({"vertices": 10**12}, "its rows do not fit its vertices"),
        ({"fps_num": 0}, "fps_num is '0'"),
        ({"first_frame": None}, "first_frame is 'None'"),
        ({"width": "99"}, "width is '99'"),
        ({"layout_version": 2}, "layout version 2"),
    ],
)
def test_a_description_that_lies_is_refused_in_one_line(tmp_path, changed, said):
    take = PlayedTake(tmp_path, count=3).bake()
    spoil(take, **changed)
    with pytest.raises(errors.InputError, match=said):
        export_mdd.main(take.options("exr", "json", mdd="mesh.mdd"))
    assert not list(tmp_path.glob("*.mdd"))


@pytest.mark.parametrize("share", [0.02, 0.3, 0.7, 0.98])
def test_a_picture_cut_short_is_refused_and_nothing_is_written(tmp_path, share):
    take = PlayedTake(tmp_path, count=70).bake()
    path = tmp_path / "mesh.exr"
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    with pytest.raises(errors.InputError, match="bake"):
        export_mdd.main(take.options("exr", "json", mdd="mesh.mdd"))
    assert not list(tmp_path.glob("*.mdd"))
