import json
from fractions import Fraction

import numpy as np
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from stages.files import errors, model, series

RATE = Fraction(30000, 1001)


@settings(max_examples=25)
@given(values=hnp.arrays(np.float32, st.tuples(st.integers(1, 20), st.integers(1, 4), st.just(2))))
def test_points_come_back_as_they_were(tmp_path_factory, values):
    path = tmp_path_factory.mktemp("series") / "a.parquet"
    names = [f"p_{index}" for index in range(values.shape[1])]
    frame = np.arange(len(values))
    series.write(path, "tracked", frame, frame / 30, series.unstack(values, names), RATE, {"a": 1})
    read = series.read(path, "tracked")
    np.testing.assert_array_equal(series.stack(read, path, names), values)
    assert series.point_names(read) == names
    assert read.rate == RATE and read.meta["a"] == 1


def test_another_kind_a_missing_column_and_no_parquet_are_refused_by_name(tmp_path):
    path = tmp_path / "a.parquet"
    series.write(path, "tracked", np.arange(2), np.arange(2), {"a.x": np.zeros(2)}, RATE)
    with pytest.raises(errors.InputError, match=r"a\.parquet: .*'tracked', expected 'expression'"):
        series.read(path, "expression")
    with pytest.raises(errors.InputError, match=r"column b\.y is missing"):
        series.stack(series.read(path, "tracked"), path, ["b"], "y")
    path.write_bytes(b"nothing of the kind")
    with pytest.raises(errors.InputError, match="no Parquet file"):
        series.read(path, "tracked")


def test_metadata_names_sources_by_content_and_holds_no_folder(tmp_path):
    source = tmp_path / "film.mp4"
    source.write_bytes(b"abc")
    path = tmp_path / "a.parquet"
    series.write(path, "tracked", np.arange(1), np.zeros(1), {}, RATE, sources=[source])
    meta = json.loads(pq.read_schema(path).metadata[b"keyface"])
    assert meta["sources"][0]["sha256"].startswith("ba7816bf")
    assert str(tmp_path) not in json.dumps(meta)


def test_the_same_content_gives_the_same_bytes(tmp_path):
    arrays = {"a": np.arange(5.0), "names": np.array(["x", "y"])}
    for name in ("one", "two"):
        model.write(tmp_path / name, "tracker", arrays, {"k": [1, 2]})
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()
    found, meta = model.read(tmp_path / "one", "tracker")
    np.testing.assert_array_equal(found["names"], arrays["names"])
    assert meta["k"] == [1, 2]
    with pytest.raises(errors.InputError, match="expected 'rig'"):
        model.read(tmp_path / "one", "rig")


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "a.parquet"
    series.write(path, "tracked", np.arange(1), np.zeros(1), {}, RATE)
    before = path.read_bytes()
    with pytest.raises(ValueError, match="length"):
        series.write(path, "tracked", np.arange(2), np.zeros(1), {}, RATE)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.parquet"]
