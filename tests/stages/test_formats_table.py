"""The table of formats: all is well on a sound take, and a fault in any file is found."""

import shutil
from fractions import Fraction

import numpy as np
import pytest
from played_take import PlayedTake

from bench import float64_mesh, format_readers, formats


@pytest.fixture(scope="module", params=["y", "z"])
def take(request, tmp_path_factory):
    show = tmp_path_factory.mktemp("show") / "results"
    folder = show / "takes" / "shot" / "face"
    folder.mkdir(parents=True)
    made = PlayedTake(folder, request.param, Fraction(24000, 1001), 11, 9, 2.0)
    (show / "cast" / "ada" / "face").mkdir(parents=True)
    shutil.copy(folder / "rig.npz", show / "cast" / "ada" / "face")
    return made


def test_every_reader_agrees_with_the_float64_mesh(take, tmp_path, capsys):
    assert formats.check(take.folder, tmp_path)
    rows = capsys.readouterr().out.splitlines()[4:]
    assert [row.split("  ")[0] for row in rows] == [name for name, *_ in format_readers.READERS]
    assert all(row.split()[-2:] == ["9", f"{take.last_time:.6f}"] for row in rows)


def test_the_float64_mesh_is_that_of_the_tests(take):
    times, found = float64_mesh.positions(
        float64_mesh.rig_of(take.folder), take.folder / "weights.parquet"
    )
    assert take.worst(found) < 1e-7
    assert times[-1] == take.last_time


def test_a_vertex_a_frame_and_a_time_that_are_wrong_are_called_so(take, capsys):
    times, places = np.arange(5) / 30, np.random.default_rng(0).normal(size=(5, 7, 3))
    off = places.copy()
    off[3, 2, 1] += 1e-3
    names, truth = ("format", "reader"), (times, places)
    assert formats.compare(names, truth, truth, 1e-5)
    for found in ((times, off), (times[1:], places[1:]), (times + 1 / 30, places)):
        assert not formats.compare(names, found, truth, 1e-5)
    assert capsys.readouterr().out.count("WRONG") == 3
