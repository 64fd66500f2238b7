from fractions import Fraction

import numpy as np
import pytest
import recorded_curves
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recorded_curves import CANONICAL, Take

from stages import import_curves
from stages.files import delimited, errors, series

RATES = ["24000/1001", "24", "25", "30000/1001", "30", "50", "60000/1001", "60", "120"]
CHECKS = ("check", "channel", "detail", "cure")


def run(folder, curve_file, rate=""):
    words = ["--curve-file", str(curve_file), "--rate", rate]
    words += ["--names", str(recorded_curves.NAMES_TABLE)]
    words += ["--curves", str(folder / "curves.parquet"), "--checks", str(folder / "checks.tsv")]
    import_curves.main([*words, "--head-motion", str(folder / "head.parquet")])
    return series.read(folder / "curves.parquet", "curves")


def stacked(read):
    return np.stack([read.columns[name] for name in CANONICAL], axis=1)


def found_checks(folder):
    rows = delimited.read(folder / "checks.tsv", CHECKS)
    return [(row.cells["check"], row.cells["channel"]) for row in rows]


@pytest.mark.parametrize("writer", recorded_curves.WRITERS, ids=lambda writer: writer.__name__)
def test_every_file_gives_the_same_take(tmp_path, writer):
    dropped = () if writer is recorded_curves.arrays_json else (7, 8, 20)
    take = Take(dropped=dropped)
    read = run(tmp_path, writer(take, tmp_path))
    known = np.array([frame not in dropped for frame in range(30)])
    values = take.values.copy()
    for gap in ((6, 9), (19, 21)) if dropped else ():
        values[slice(*gap)] = np.linspace(values[gap[0]], values[gap[1]], gap[1] - gap[0] + 1)[:-1]
    if writer in (recorded_curves.mediapipe_json, recorded_curves.mediapipe_csv):
        values[:, CANONICAL.index("tongueOut")] = 0
        assert read.meta["missing"] == ["tongueOut"]
        assert ("missing", "tongueOut") in found_checks(tmp_path)
    np.testing.assert_allclose(stacked(read), values, atol=1e-6)
    np.testing.assert_array_equal(read.columns["confidence"], known)
    assert read.rate == 30 and len(read.frame) == 30
    assert read.time_s[-1] == 29 / 30
    assert ("gaps", "") in found_checks(tmp_path) or not dropped


@pytest.mark.parametrize("rate", [Fraction(rate) for rate in RATES], ids=RATES)
@pytest.mark.parametrize(
    "writer", [recorded_curves.live_link, recorded_curves.mediapipe_csv], ids=lambda w: w.__name__
)
def test_rates_keep_their_frames_and_last_time(tmp_path, writer, rate):
    count = 3 * int(rate)
    take = Take(count, rate, dropped={5, count - 4})
    read = run(tmp_path, writer(take, tmp_path))
    assert (read.rate, len(read.frame)) == (rate, count)
    assert read.time_s[-1] == float((count - 1) / rate)
    known = read.columns["confidence"] == 1
    assert np.flatnonzero(~known).tolist() == [5, count - 4]
    kept = np.array([name != "tongueOut" for name in CANONICAL])
    np.testing.assert_allclose(
        stacked(read)[known][:, kept], take.values[known][:, kept], atol=1e-6
    )


@given(
    st.sampled_from([Fraction(rate) for rate in RATES]),
    st.integers(2, 40),
    st.floats(0, 86399),
    st.integers(0, 1000),
)
@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_live_link_comes_back_from_any_time_of_day(tmp_path, rate, count, start_s, seed):
    take = Take(count, rate, seed=seed, start_s=start_s)
    # a take this short tells its rate only roughly
    read = run(tmp_path, recorded_curves.live_link(take, tmp_path), rate=str(rate))
    np.testing.assert_allclose(stacked(read), take.values, atol=1e-6)
    assert len(read.frame) == count and read.meta["start_s"] == pytest.approx(start_s, abs=1e-4)


def test_midnight_spellings_and_the_start(tmp_path):
    take = Take(start_s=86399.5)
    path = recorded_curves.live_link(take, tmp_path, spelling="BlendshapeCount")
    read = run(tmp_path, path)
    assert read.meta["start_timecode"] == "23:59:59:15" and read.meta["start_s"] == 86399.5
    np.testing.assert_allclose(stacked(read), take.values, atol=1e-6)
    assert found_checks(tmp_path) == []
    # the order of the columns does not matter, their names do
    header, rest = path.read_text().split("\n", 1)
    path.write_text(header.replace("JawRight,JawLeft", "JawLeft,JawRight") + "\n" + rest)
    read = run(tmp_path, path)
    right, left = CANONICAL.index("jawRight"), CANONICAL.index("jawLeft")
    np.testing.assert_allclose(read.columns["jawLeft"], take.values[:, right], atol=1e-6)
    np.testing.assert_allclose(read.columns["jawRight"], take.values[:, left], atol=1e-6)


def test_the_heads_angles_become_its_motion(tmp_path):
    take = Take()
    take.angles[:] = 0
    take.angles[3, 0], take.angles[4, 1], take.angles[5, 3] = 0.4, 0.2, 0.3
    run(tmp_path, recorded_curves.live_link(take, tmp_path))
    motion = series.read(tmp_path / "head.parquet", "head_motion").columns
    turns = np.stack([motion[f"rotation.{axis}"] for axis in "xyzw"], axis=1)
    np.testing.assert_allclose(turns[0], [0, 0, 0, 1], atol=1e-7)
    # to the subject's right: the face's z axis moves towards -x
    np.testing.assert_allclose(turns[3], [0, -np.sin(0.2), 0, np.cos(0.2)], atol=1e-6)
    np.testing.assert_allclose(turns[4], [np.sin(0.1), 0, 0, np.cos(0.1)], atol=1e-6)
    assert motion["eye_left.y"][5] == pytest.approx(-0.3)
    assert (motion["scale"] == 1).all() and (motion["translation.x"] == 0).all()


def test_a_lost_face_is_a_gap_and_a_clock_that_drifts_is_said(tmp_path):
    take = Take(count=40)
    path = recorded_curves.live_link(take, tmp_path)
    lines = path.read_text().splitlines()
    lines[8] = lines[8].split(",")[0] + ",0" + "," * 61
    path.write_text("\n".join(lines))
    read = run(tmp_path, path)
    assert np.flatnonzero(read.columns["confidence"] == 0).tolist() == [7]
    np.testing.assert_allclose(stacked(read)[7], take.values[[6, 8]].mean(axis=0), atol=1e-6)
    long = Take(count=600, rate=Fraction(30030, 1000))
    read = run(tmp_path, recorded_curves.live_link(long, tmp_path))
    assert read.rate == 30 and len(read.frame) == 599
    assert ("clock", "") in found_checks(tmp_path)


def test_timecodes_of_thirty_frames_a_second_are_told(tmp_path):
    take = Take(count=90, start_s=100.0)
    path = recorded_curves.live_link(take, tmp_path)
    lines = path.read_text().splitlines()
    for row in range(90):
        seconds, part = divmod(row, 30)
        cells = lines[row + 1].split(",")
        lines[row + 1] = ",".join([f"00:01:{40 + seconds:02d}:{part:02d}.000", *cells[1:]])
    path.write_text("\n".join(lines))
    read = run(tmp_path, path)
    assert read.rate == 30 and (read.columns["confidence"] == 1).all()


def test_what_looks_wrong_is_listed(tmp_path):
    take = Take(count=60)
    take.values *= 100
    path = recorded_curves.live_link(take, tmp_path)
    path.write_text(path.read_text().replace("TongueOut", "TongueWag"))
    run(tmp_path, path)
    assert {("range_0_100", ""), ("missing", "tongueOut"), ("unknown", "TongueWag")} <= set(
        found_checks(tmp_path)
    )


@pytest.mark.parametrize(
    ("writer", "change", "fault"),
    [
        ("live_link", lambda t: t + t.splitlines()[-4], "its timecode does not follow the one"),
        ("live_link", lambda t: t[: len(t) * 2 // 3], "has .* cells, the header has 63: is it cut"),
        ("live_link", lambda t: t.replace(":", ";", 1).replace("13;13", "1313"), "is no timecode"),
        ("live_link", lambda t: t.replace(":31.", ":71."), "line 2, column Timecode: '13:13:04:71"),
        ("live_link", lambda t: t.replace(",0.", ",x0."), "line 2, column EyeBlinkLeft: 'x0"),
        ("live_link", lambda t: t.replace(",0.", ",inf0."), "line 2, column EyeBlinkLeft: 'inf0"),
        ("live_link", lambda t: t.splitlines()[0], "holds no row below its header"),
        ("live_link", lambda t: t.replace("JawLeft", "JawRight"), "'JawRight' stands twice"),
        ("live_link", lambda t: t.replace("Timecode", "Code"), "has no times|no number"),
        ("live_link", lambda t: t.replace("\n13:13:05", "\n23:13:05"), "stand for .* frames"),
        ("arkit_json", lambda t: t[:-30], "line 1, column .* is it cut short"),
        ("arkit_json", lambda t: t.replace('"jawOpen": 0.', '"jawOpen": "0.'), "line 1, column"),
        ("arkit_json", lambda t: t.replace('"jawOpen":', '"a": 1e999, "jawOpen":'), "not finite"),
        ("arkit_json", lambda t: t.replace('"frame": 9,', '"frame": 8,'), "its number 8 does not"),
        ("arkit_json", lambda t: t.replace('"frame": 9,', '"frame": 1e999,'), "its number is inf"),
        ("arrays_json", lambda t: t.replace('"EyeBlinkLeft", ', ""), "has 52 weights for 51"),
        ("arrays_json", lambda t: t.replace("exportFps", "speed"), "has no times: correct it"),
        ("arkit_csv", lambda t: t.replace("_L", "_Q").replace("_R", "_Q"), "stands twice"),
        ("mediapipe_csv", lambda t: t.replace("\n4,", "\n3,"), "line 6: its frame does not"),
        ("mediapipe_csv", lambda t: t.replace("\n4,", '\n"4,'), "line "),
        ("mediapipe_json", lambda t: t.replace("jaw", "chin"), None),
        ("mediapipe_json", lambda t: t.replace("score", "s"), "has no score: export"),
    ],
)
def test_bad_input_is_one_line(tmp_path, writer, change, fault):
    path = getattr(recorded_curves, writer)(Take(), tmp_path)
    path.write_text(change(path.read_text(encoding="utf-8")))
    if fault is None:
        run(tmp_path, path)
        assert ("unknown", "chinOpen") in found_checks(tmp_path)
        return
    with pytest.raises(errors.InputError, match=fault) as raised:
        run(tmp_path, path)
    assert "\n" not in str(raised.value) and str(raised.value).startswith(str(path))
    assert not (tmp_path / "curves.parquet").exists()


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        ("Timecode,ä".encode("latin-1"), "no UTF-8 text at byte 9"),
        (b"", "is empty"),
        (b"frame,x\n1,2\n", "holds no curves, it starts 'frame, x'"),
        (b"{}", "holds no weights"),
        (b"[" * 50000, "is no sensible JSON|expecting value"),
        (b'{"frames": 3}', "holds no weights"),
    ],
)
def test_what_are_no_curves_is_refused(tmp_path, data, fault):
    path = tmp_path / "take.csv"
    path.write_bytes(data)
    with pytest.raises(errors.InputError, match=rf"take\.csv: .*({fault})"):
        run(tmp_path, path)
    with pytest.raises(errors.InputError, match="no such curves"):
        run(tmp_path, tmp_path / "lost.csv")
