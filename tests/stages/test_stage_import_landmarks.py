import json
from fractions import Fraction

import numpy as np
import other_trackers
import pytest

from stages import import_landmarks, merge_capture
from stages.files import errors, film_writer, series

FLOAT32 = 2e-5  # of coordinates of some hundred pixels
RATES = ["24000/1001", "24", "25", "30000/1001", "30", "50", "60000/1001", "60", "120"]


def run(folder, landmarks, video=None, rate=""):
    tracked = folder / "imported.parquet"
    words = ["--landmarks", str(landmarks), "--maps", *other_trackers.MAPS, "--rate", rate]
    words += ["--tracked", str(tracked), "--video", *([video] if video else [])]
    import_landmarks.main(words)
    return series.read(tracked, "tracked")


@pytest.mark.parametrize("writer", other_trackers.WRITERS, ids=lambda writer: writer.__name__)
def test_every_tracker_gives_the_same_take(tmp_path, writer):
    take = other_trackers.Take()
    tracker, precision = other_trackers.WRITERS[writer]
    video = take.film(tmp_path / "a.mp4")
    read = run(tmp_path, writer(take, tmp_path), video)
    names, points = take.expected(tracker)
    assert series.point_names(read) == names == read.meta["points"]
    np.testing.assert_allclose(
        series.stack(read, "", names), points, rtol=0, atol=precision + FLOAT32
    )
    np.testing.assert_array_equal(read.frame, np.arange(9))
    np.testing.assert_allclose(read.time_s, take.times, atol=1e-4)
    assert read.rate == take.rate and read.meta["picture_size"] == [320, 240]
    found = np.isfinite(points[:, 0, 0])
    np.testing.assert_array_equal(read.columns["confidence"] > 0, found)
    np.testing.assert_array_equal(read.columns["lips_outer_03.confidence"] > 0, found)
    if writer is other_trackers.openface:
        np.testing.assert_allclose(read.columns["confidence"][found], 0.98, atol=1e-6)


@pytest.mark.parametrize("rate", [Fraction(rate) for rate in RATES], ids=RATES)
def test_times_in_milliseconds_tell_the_rate(tmp_path, rate):
    count = 2 * int(rate) + 4
    lost = {4, 5, count - 9}
    face = np.random.default_rng(0).uniform(0.2, 0.8, (68, 2)).round(4).tolist()
    frames = [
        {"frame_index": frame, "timestamp": round(1000 * frame / rate), "points": face}
        for frame in range(count)
        if frame not in lost
    ]
    about = {"frames": frames, "width": 320, "height": 240}
    (tmp_path / "take.json").write_text(json.dumps(about))
    read = run(tmp_path, tmp_path / "take.json")
    assert read.rate == rate
    np.testing.assert_array_equal(read.frame, np.arange(count))
    np.testing.assert_allclose(read.time_s, np.arange(count) / float(rate), atol=0.51e-3)
    assert set(np.flatnonzero(read.columns["confidence"] == 0)) == lost
    # from here on the clock is exact
    performance = tmp_path / "performance.parquet"
    words = ["--tracked", str(tmp_path / "imported.parquet"), "--performance", str(performance)]
    merge_capture.main(words)
    merged = series.read(performance, "performance")
    assert (len(merged.frame), merged.rate) == (count, rate)
    assert merged.time_s[-1] == float((count - 1) / rate)


@pytest.mark.parametrize("rate", [Fraction(rate) for rate in RATES], ids=RATES)
def test_a_films_rate_and_times_count(tmp_path, rate):
    take = other_trackers.Take(20, rate)
    read = run(tmp_path, other_trackers.keyface(take, tmp_path), take.film(tmp_path / "a.mp4"))
    assert read.rate == rate
    np.testing.assert_allclose(read.time_s, take.times, atol=1e-4)
    np.testing.assert_array_equal(read.frame, np.arange(20))


def test_a_film_of_varying_rate_keeps_its_times(tmp_path):
    take = other_trackers.Take(count=6, lost=())
    take.times = [0.0, 0.04, 0.10, 0.13, 0.21, 0.25]
    grey = np.full((240, 320, 3), 90, np.uint8)
    pictures = ((time, grey) for time in take.times)
    film_writer.write(tmp_path / "a.mp4", pictures, (320, 240), take.rate)
    for writer in (other_trackers.keyface, other_trackers.mediapipe_lines):
        read = run(tmp_path, writer(take, tmp_path), str(tmp_path / "a.mp4"))
        np.testing.assert_allclose(read.time_s, take.times, atol=1e-4)
        names, points = take.expected("mediapipe")
        np.testing.assert_allclose(series.stack(read, "", names), points, atol=2e-4)


def test_what_lacks_a_film_needs_a_rate(tmp_path):
    take = other_trackers.Take()
    table = other_trackers.openface(take, tmp_path)
    with pytest.raises(errors.InputError, match=r"openface\.csv: its times step by 0.001 s.*rate"):
        run(tmp_path, table)
    read = run(tmp_path, table, rate="24000/1001")
    assert read.rate == Fraction(24000, 1001)
    np.testing.assert_allclose(read.time_s, np.arange(9) * 1001 / 24000)
    own = other_trackers.keyface(take, tmp_path)
    with pytest.raises(errors.InputError, match=r"own\.csv: has neither times nor a rate"):
        run(tmp_path, own)
    with pytest.raises(errors.InputError, match="--rate: 'fast' is no rate"):
        run(tmp_path, own, rate="fast")
    lines = other_trackers.mediapipe_lines(take, tmp_path)
    with pytest.raises(errors.InputError, match="size is not known: give its film"):
        run(tmp_path, lines)


def test_frames_that_the_tracker_skipped_are_no_gaps(tmp_path):
    take = other_trackers.Take(count=12, lost=())
    video = take.film(tmp_path / "a.mp4")
    table = other_trackers.pyfeat(take, tmp_path)
    rows = table.read_text().splitlines()
    table.write_text("\n".join([rows[0], *rows[1::2]]) + "\n")
    read = run(tmp_path, table, video)
    np.testing.assert_array_equal(read.frame, np.arange(0, 12, 2))
    assert (read.columns["confidence"] > 0).all()
    # a face that was lost at the start and the end leaves rows without points
    own = other_trackers.keyface(take, tmp_path)
    rows = own.read_text().splitlines()
    own.write_text("\n".join([rows[0], *rows[3:7], *rows[8:11]]) + "\n")
    read = run(tmp_path, own, video)
    np.testing.assert_array_equal(read.frame, np.arange(12))
    lost = np.flatnonzero(read.columns["confidence"] == 0)
    np.testing.assert_array_equal(lost, [0, 1, 6, 10, 11])


@pytest.mark.parametrize(
    ("writer", "change", "fault"),
    [
        ("keyface", lambda t: t + t.splitlines()[-1] + "\n", "line 11: frame 8 stands twice"),
        ("keyface", lambda t: t[: len(t) * 2 // 3], "line 7 has .* cells, the header has 189"),
        ("keyface", lambda t: t.replace(".x", ".u"), "holds no landmarks, it starts 'frame, brow"),
        ("keyface", lambda t: t.replace("\n2,", "\n22,"), "line 5: frame 3 follows 22"),
        ("keyface", lambda t: t.replace("\n8,", "\n80000,"), "has frames 0 to 80000, the film 0"),
        ("keyface", lambda t: t.replace("\n2,", "\n2,!"), "line 4, column brow_right_00.x: '!"),
        ("openface", lambda t: t.replace(",1,", ",0,"), "found on none of its 9 frames"),
        ("openface", lambda t: t.replace(" x_67", " x_99"), "holds no landmarks"),
        ("openface", lambda t: t.replace(" x_67", " z_67").replace(" y_67", ""), "67 points of a"),
        ("mediapipe_long", lambda t: t[: t.index("\n2,9,")], "frame has 9 points of 478"),
        ("mediapipe_long", lambda t: t.replace("\n1,0,", "\n0,477,"), "point 477 stands twice"),
        ("mediapipe_long", lambda t: t.replace("frame", "face"), "no column of frames or times"),
        ("mediapipe_json", lambda t: t[: len(t) // 2], "line 1, column .* is it cut short"),
        ("mediapipe_json", lambda t: t.replace("landmarks", "marks"), "no landmarks in its 9"),
        ("mediapipe_json", lambda t: t.replace('"y"', '"u"', 1), "frame 0 of the file"),
        ("mediapipe_json", lambda t: "[" * 100000, "is no sensible JSON|expecting value"),
        ("mediapipe_json", lambda t: t + "}", "something stands after the end"),
        ("mediapipe_flat", lambda t: t.replace("0.0,", "", 1), "numbers are no known set"),
        ("mediapipe_flat", lambda t: t.replace("[", "[" + "9" * 5000 + ",", 1), "sensible JSON"),
        ("mediapipe_lines", lambda t: t.replace("80.0", "2e9"), "its time 120 does not follow"),
        ("pyfeat", lambda t: t.replace(",320,", ",640,"), "pictures of 640x240, the film has 320"),
    ],
)
def test_bad_input_is_one_line(tmp_path, writer, change, fault):
    take = other_trackers.Take()
    path = getattr(other_trackers, writer)(take, tmp_path)
    path.write_text(change(path.read_text()))
    video = take.film(tmp_path / "a.mp4")
    with pytest.raises(errors.InputError, match=fault) as raised:
        run(tmp_path, path, video)
    assert "\n" not in str(raised.value) and str(raised.value).startswith(str(path))


@pytest.mark.parametrize(
    ("data", "fault"),
    [
        ("frame,x_0\n".encode("utf-16-be"), "UTF-16 without its mark"),
        (b"frame,\xff\xfe", "no UTF-8 text at byte 6"),
        (b"", "is empty"),
        (b'frame,"x_0\n1,2', "holds no landmarks"),
        (b"version: 1\nn_points: 68\n{", "is one frame: give the folder"),
        (b"\x89PNG\r\n\x1a\n\0\0", "no UTF-8 text"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path, data, fault):
    path = tmp_path / "take.csv"
    path.write_bytes(data)
    with pytest.raises(errors.InputError, match=rf"take\.csv: .*{fault}"):
        run(tmp_path, path)


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("film_0002.pts", "n_points: 3\n{\n1 2\n3 4\n}", "has 2 points and says 3"),
        ("film_0002.pts", "version: 1\nn_points: 68\n{\n1 2\n", "no .pts file of points"),
        ("film_0002.pts", "n_points: 1\n{\n1 two\n}", "not all its points are two numbers"),
        ("film_0002.pts", "n_points: 1\n{\n1 2\n}", "has 1 points, film_0001.pts 68"),
        ("other_002.pts", "n_points: 1\n{\n1 2\n}", "has the number 2 of film_0002.pts"),
        ("film.pts", "n_points: 1\n{\n1 2\n}", "has no number in its name"),
    ],
)
def test_faulty_pts_are_named(tmp_path, name, text, fault):
    folder = other_trackers.ibug(other_trackers.Take(), tmp_path)
    (folder / name).write_text(text)
    with pytest.raises(errors.InputError, match=rf"{name}: .*{fault}"):
        run(tmp_path, folder, rate="25")


@pytest.mark.parametrize("number", ["1e300", "1e18", "-5", "1.5", "1" + "0" * 400])
@pytest.mark.parametrize("key", ["frame", "time"])
def test_absurd_numbers_are_refused_before_anything_is_made_of_them(tmp_path, number, key):
    frames = [{key: place, "landmarks": [[0.1, 0.2]] * 68} for place in (0, 1, "?")]
    text = json.dumps({"width": 320, "height": 240, "frames": frames}).replace('"?"', number)
    (tmp_path / "a.json").write_text(text)
    columns = ",".join(f"x_{i},y_{i}" for i in range(68))
    lines = [f"{key},{columns}", *(f"{place}{',50' * 136}" for place in (0, 1, number))]
    (tmp_path / "a.csv").write_text("\n".join(lines))
    for name in ("a.json", "a.csv"):
        if (key, number) == ("time", "1.5"):
            continue
        with pytest.raises(errors.InputError, match=name):
            run(tmp_path, tmp_path / name, rate="25")


def test_an_empty_folder_and_a_missing_file(tmp_path):
    (tmp_path / "pts").mkdir()
    with pytest.raises(errors.InputError, match=r"holds no \.pts file"):
        run(tmp_path, tmp_path / "pts")
    with pytest.raises(errors.InputError, match="no such landmarks"):
        run(tmp_path, tmp_path / "lost.csv")


def test_the_wrong_film_is_noticed(tmp_path):
    take = other_trackers.Take(lost=())
    longer = other_trackers.Take(count=7)
    video = longer.film(tmp_path / "b.mp4")
    for writer in (other_trackers.openface, other_trackers.mediapipe_flat):
        with pytest.raises(errors.InputError, match=r"is .*b\.mp4 its film\?"):
            run(tmp_path, writer(take, tmp_path), video)
    take.points += 3000
    with pytest.raises(errors.InputError, match=r"outside the picture 320x240"):
        run(tmp_path, other_trackers.keyface(take, tmp_path), take.film(tmp_path / "a.mp4"))
