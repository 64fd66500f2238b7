import json
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stages import merge_capture
from stages.core import clock
from stages.files import errors, film_writer, series

MARKER_RATE = Fraction(120)
FILM_RATES = [Fraction(25), Fraction(30000, 1001), Fraction(24000, 1001), Fraction(60)]


def write_markers(path, points, repaired=None, rate=MARKER_RATE, names=("chin",)):
    count = len(points)
    repaired = np.zeros((count, len(names))) if repaired is None else repaired
    columns = series.unstack(points, names, "xyz")
    columns |= {f"{name}.repaired": repaired[:, n] for n, name in enumerate(names)}
    columns["confidence"] = np.isfinite(points[..., 0]).mean(axis=1)
    times = clock.frame_times(count, rate)
    series.write(path, "markers", np.arange(count), times, columns, rate, {"units": "mm"})
    return str(path)


def write_tracked(path, last_s, rate, position=lambda t: t):
    count = clock.frame_count(last_s, rate)
    times = clock.frame_times(count, rate)
    columns = {"lip.x": position(times), "lip.y": times, "lip.confidence": np.ones(count)}
    columns["confidence"] = np.full(count, 0.75)
    meta = {"picture_size": [640, 480]}
    series.write(path, "tracked", np.arange(count), times, columns, rate, meta)
    return str(path)


def write_sync(path, offset_s, drift_ppm=0.0, refused=False, reason=""):
    fields = {"offset_s": None if refused else offset_s, "drift_ppm": drift_ppm, "reason": reason}
    fields |= {"confidence": 0.9, "method": "gcc_phat", "refused": refused}
    path.write_text(json.dumps(fields), encoding="utf-8")
    return str(path)


def merge(folder, **inputs):
    target = folder / "performance.parquet"
    command = [part for flag, path in inputs.items() for part in (f"--{flag}", path)]
    merge_capture.main([*command, "--performance", str(target)])
    return series.read(target, "performance")


@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=20, deadline=None
)
@given(st.sampled_from(FILM_RATES), st.floats(-2, 2), st.floats(-200, 200))
def test_a_marker_sinusoid_comes_out_at_the_films_times(tmp_path, rate, offset, drift):
    def position(t):
        return 10 * np.sin(2 * np.pi * 3 * t + 0.3)

    own = np.arange(1200) / 120
    in_film = (1 + drift * 1e-6) * own + offset
    points = np.repeat(position(in_film)[:, None, None], 3, axis=2)
    found = merge(
        tmp_path,
        tracked=write_tracked(tmp_path / "tracked.parquet", 4.2, rate, position),
        markers=write_markers(tmp_path / "markers.parquet", points),
        sync=write_sync(tmp_path / "sync.json", offset, drift),
    )
    assert found.rate == 120
    np.testing.assert_array_equal(found.time_s, np.arange(len(found.frame)) / 120)
    last = clock.frame_times(clock.frame_count(4.2, rate), rate)[-1]
    assert abs(found.time_s[-1] - last) <= 0.5 / 120 + 1e-9
    inside = (found.time_s > in_film[0] - 1e-7) & (found.time_s < in_film[-1] + 1e-7)
    chin = found.columns["chin.x"]
    np.testing.assert_array_equal(np.isfinite(chin), inside)
    inner = inside & (found.time_s > in_film[1]) & (found.time_s < in_film[-2])
    np.testing.assert_allclose(chin[inner], position(found.time_s[inner]), atol=2e-4)
    np.testing.assert_array_equal(found.columns["markers.confidence"], inside.astype(float))
    # a film of 25 pictures has less to say of 3 Hz, but at the same time
    lag = np.argmax(
        [
            chin[inner][20:-20] @ np.roll(found.columns["lip.x"][inner], n)[20:-20]
            for n in range(-9, 10)
        ]
    )
    assert lag == 9
    assert set(found.columns["confidence"]) == {0.75}


def test_markers_alone_keep_their_own_clock_and_every_bit(tmp_path):
    points = np.random.default_rng(0).normal(size=(50, 1, 3))
    points[7] = np.nan
    rate = Fraction(100)
    found = merge(tmp_path, markers=write_markers(tmp_path / "m.parquet", points, rate=rate))
    assert found.rate == rate
    chin = series.stack(found, "performance", ["chin"], "xyz")
    np.testing.assert_array_equal(chin, points.astype(np.float32))
    confidence = np.isfinite(points[:, 0, 0]).astype(float)
    for name in ("confidence", "markers.confidence"):
        np.testing.assert_array_equal(found.columns[name], confidence)


def test_markers_in_step_with_the_film_pass_through(tmp_path):
    points = np.random.default_rng(1).normal(size=(300, 1, 3))
    markers = write_markers(tmp_path / "m.parquet", points)
    sync = write_sync(tmp_path / "sync.json", 0.5)
    tracked = write_tracked(tmp_path / "t.parquet", 2.0, Fraction(25))
    found = merge(tmp_path, tracked=tracked, markers=markers, sync=sync)
    chin = series.stack(found, "performance", ["chin"], "xyz")
    np.testing.assert_array_equal(chin[60:], points.astype(np.float32)[: len(chin) - 60])
    assert np.isnan(chin[:60]).all()


def test_gaps_and_repairs_do_not_spread(tmp_path):
    points = np.random.default_rng(2).normal(size=(240, 1, 3))
    points[100:103] = np.nan
    repaired = np.zeros((240, 1))
    repaired[50], repaired[51] = 1, 2
    markers = write_markers(tmp_path / "m.parquet", points, repaired)
    sync = write_sync(tmp_path / "sync.json", 0.3 / 120)
    tracked = write_tracked(tmp_path / "t.parquet", 1.5, Fraction(30))
    found = merge(tmp_path, tracked=tracked, markers=markers, sync=sync)
    lost = np.flatnonzero(np.isnan(found.columns["chin.y"]))
    np.testing.assert_array_equal(lost, [0, 100, 101, 102, 103])
    marks = found.columns["chin.repaired"]
    np.testing.assert_array_equal(marks[49:54], [0, 1, 2, 2, 0])


def test_a_film_that_was_not_tracked_gives_its_length(tmp_path):
    video = tmp_path / "film.mp4"
    rate = Fraction(30000, 1001)
    picture = np.zeros((48, 64, 3), np.uint8)
    film_writer.write(video, ((n / float(rate), picture) for n in range(31)), (64, 48), rate)
    markers = write_markers(tmp_path / "m.parquet", np.zeros((200, 1, 3)))
    sync = write_sync(tmp_path / "sync.json", -0.25)
    found = merge(tmp_path, video=str(video), markers=markers, sync=sync)
    assert len(found.frame) == clock.frame_count(30 / float(rate), MARKER_RATE)
    np.testing.assert_array_equal(found.columns["confidence"], found.columns["markers.confidence"])
    assert found.columns["confidence"].min() == 1


def test_what_cannot_be_brought_together_says_why(tmp_path):
    markers = write_markers(tmp_path / "m.parquet", np.zeros((200, 1, 3)))
    tracked = write_tracked(tmp_path / "t.parquet", 1.0, Fraction(30))
    with pytest.raises(errors.InputError, match="no sync with it.*set sync_offset_s in shots.tsv"):
        merge(tmp_path, tracked=tracked, markers=markers)
    sync = write_sync(tmp_path / "sync.json", 0, refused=True, reason="the sound is silent")
    with pytest.raises(errors.InputError, match=r"sync.json.*the sound is silent.*sync_offset_s"):
        merge(tmp_path, tracked=tracked, markers=markers, sync=sync)
    sync = write_sync(tmp_path / "sync.json", 30.0)
    with pytest.raises(errors.InputError, match=r"covers 30.00 to 31.67 s.*the film 0 to 1.00 s"):
        merge(tmp_path, tracked=tracked, markers=markers, sync=sync)
    (tmp_path / "sync.json").write_text("[1", encoding="utf-8")
    with pytest.raises(errors.InputError, match="is no sync"):
        merge(tmp_path, tracked=tracked, markers=markers, sync=sync)
    with pytest.raises(errors.InputError, match="neither video nor markers"):
        merge(tmp_path)
    with pytest.raises(ValueError, match="--markers takes one file, got 2"):
        merge_capture.main(["--markers", markers, markers, "--performance", "p.parquet"])
