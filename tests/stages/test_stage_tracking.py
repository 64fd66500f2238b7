"""From films and labels to tracked points and proposals, through the stages' command lines."""

import csv
from fractions import Fraction

import av
import drawn_face
import numpy as np
import pytest

from stages import cli, propose_labels, track_video, train_tracker
from stages.files import series

LABELLED = 6
LOST = range(12, 16)
BLINK = (10, 11)  # the lids hide the pupils


def write_film(path, pictures):
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=Fraction(30), options={"crf": "12"})
        stream.width, stream.height, stream.pix_fmt = drawn_face.WIDTH, drawn_face.HEIGHT, "yuv420p"
        for picture in pictures:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())
    return str(path)


def write_labels(path, shapes, change=None):
    corners = {"eye_right_00", "eye_right_04", "eye_left_00", "eye_left_04"}
    corners |= {f"lips_{which}_{i:02d}" for which in ("outer", "inner") for i in (0, 6)}
    with path.open("w", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(["frame", "point", "x_px", "y_px", "corner"])
        for frame, shape in enumerate(shapes):
            for name, (x, y) in zip(drawn_face.names(), shape, strict=True):
                row = [frame, name, f"{x:.2f}", f"{y:.2f}", "1" if name in corners else ""]
                row = change(row) if change else row
                if row:
                    table.writerow(row)
    return str(path)


@pytest.fixture(scope="module")
def show(tmp_path_factory):
    """A folder with a labelled film, a talking film with a gap, and the tracker of both."""
    folder = tmp_path_factory.mktemp("tracking")
    pictures, shapes = drawn_face.training(LABELLED)
    write_film(folder / "labelled.mp4", pictures)
    write_labels(folder / "labels.csv", shapes)
    talking, truth = drawn_face.talking(24)
    for t in LOST:
        talking[t] = np.full_like(talking[t], 80)
    write_film(folder / "talk.mp4", talking)
    counts = {"brow_right": 5, "brow_left": 5, "lips_outer": 12, "lips_inner": 12}
    lines = ["contour\tkind\tcount"]
    for name, kind in drawn_face.CONTOURS.items():
        lines.append(f"{name}\t{kind}\t{counts.get(name, '' if kind == 'closed' else 1)}")
    (folder / "points.tsv").write_text("\n".join(lines) + "\n")
    train(folder)
    track_video.main(arguments(folder, "track", "talk.mp4"))
    return folder, truth


def arguments(folder, what, film="labelled.mp4", labels="labels.csv"):
    paths = {
        "train": ["--videos", film, "--labels", labels, "--point-set", "points.tsv"],
        "track": ["--video", film],
    }[what]
    paths += ["--tracker", "tracker.npz"]
    paths += ["--tracked", f"{film[:-4]}.parquet"] if what == "track" else []
    found = [one if one.startswith("--") else str(folder / one) for one in paths]
    return found + (["--shots", "first", "--seed", "1"] if what == "train" else [])


def train(folder, **changes):
    train_tracker.main(arguments(folder, "train", **changes))


def test_every_frame_is_a_row_and_lost_ones_are_nan(show):
    folder, truth = show
    read = series.read(folder / "talk.parquet", "tracked")
    names = series.point_names(read)
    points = series.stack(read, "talk.parquet", names)
    assert read.frame.tolist() == list(range(24))
    assert read.rate == 30
    np.testing.assert_allclose(read.time_s, np.arange(24) / 30, atol=1e-6)
    lost = np.isin(read.frame, LOST)
    assert np.isnan(points[lost]).all()
    assert (read.columns["confidence"][lost] == 0).all()
    assert (read.columns["lips_inner_03.confidence"][lost] == 0).all()
    assert (read.columns["confidence"][~lost] > 0.5).all()
    assert read.meta["picture_size"] == [drawn_face.WIDTH, drawn_face.HEIGHT]
    eyes = [i for i, name in enumerate(names) if name.startswith("pupil")]
    open_eyes = ~lost & ~np.isin(read.frame, BLINK)
    error = np.linalg.norm(points[open_eyes][:, eyes] - truth[open_eyes][:, eyes], axis=2)
    assert error.mean() < 0.02 * 44


def test_lips_are_resampled_between_their_corners(show):
    folder, truth = show
    read = series.read(folder / "talk.parquet", "tracked")
    names = series.point_names(read)
    points = series.stack(read, "talk.parquet", names)
    for corner in ("lips_outer_00", "lips_outer_06"):
        p = names.index(corner)
        assert np.nanmean(np.linalg.norm(points[:, p] - truth[:, p], axis=1)) < 1.0
    gaps = np.linalg.norm(
        np.diff(points[0, [names.index(f"lips_outer_{i:02d}") for i in range(7)]], axis=0), axis=1
    )
    assert np.ptp(gaps) < 0.35 * gaps.mean()


def test_proposals_skip_labels_and_give_reasons(show):
    folder, _ = show
    track_video.main(arguments(folder, "track", "labelled.mp4"))
    out = folder / "proposals.tsv"
    tracked = [str(folder / "labelled.parquet"), str(folder / "talk.parquet")]
    argv = ["--tracked", *tracked, "--shots", "first", "second", "--labelled-shots", "first"]
    propose_labels.main([*argv, "--labels", str(folder / "labels.csv"), "--proposals", str(out)])
    with out.open(newline="") as stream:
        rows = list(csv.DictReader(stream, delimiter="\t"))
    assert [int(row["rank"]) for row in rows] == list(range(1, len(rows) + 1))
    assert {row["shot"] for row in rows} == {"second"}
    gap = [row for row in rows if int(row["frame"]) in LOST]
    assert len(gap) == 1
    assert gap[0]["reason"].startswith("no face was found")


def one_line(main, argv, monkeypatch, capsys):
    """Return what a stage prints when it fails, checked to be one line."""
    monkeypatch.setattr("sys.argv", ["stage", *argv])
    with pytest.raises(SystemExit) as stop:
        cli.run_stage(main)
    lines = capsys.readouterr().err.strip().splitlines()
    assert stop.value.code == 1
    assert lines[-1].startswith("error: ")
    return lines[-1]


def test_a_film_without_a_face_is_refused_and_nothing_written(show, monkeypatch, capsys):
    folder, _ = show
    empty = np.full((drawn_face.HEIGHT, drawn_face.WIDTH, 3), 120, np.uint8)
    write_film(folder / "empty.mp4", [empty] * 5)
    said = one_line(track_video.main, arguments(folder, "track", "empty.mp4"), monkeypatch, capsys)
    assert "empty.mp4: no face was found in 5 frames" in said
    assert not (folder / "empty.parquet").exists()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda row: None if row[0] == 2 and row[1].startswith("eye_left") else row,
            "frame 2: contour eye_left is missing",
        ),
        (
            lambda row: [*row[:2], "999", *row[3:]] if row[:2] == [1, "pupil_left"] else row,
            "frame 1: pupil_left at (999.0, ",
        ),
        (lambda row: [row[0] + 40, *row[1:]] if row[0] == 5 else row, "frame 45 does not exist"),
        (lambda row: row if row[0] < 2 else None, "2 labelled frames are too few"),
        (
            lambda row: None if row[:2] == [3, "eye_left_07"] else row,
            "frame 3 has other points than",
        ),
        (
            lambda row: None if row[:2] == [3, "lips_outer_06"] else row,
            "frame 3: contour lips_outer has 1 corners",
        ),
    ],
)
def test_bad_labels_are_one_line(show, monkeypatch, capsys, change, message):
    folder, _ = show
    _, shapes = drawn_face.training(LABELLED)
    write_labels(folder / "bad.csv", shapes, change)
    argv = arguments(folder, "train", labels="bad.csv")
    said = one_line(train_tracker.main, argv, monkeypatch, capsys)
    assert "bad.csv: " in said
    assert message in said


def test_another_kind_of_file_is_no_tracker(show, monkeypatch, capsys):
    folder, _ = show
    (folder / "other").mkdir()
    argv = arguments(folder, "track", "talk.mp4")
    argv[argv.index("--tracker") + 1] = str(folder / "labels.csv")
    assert "labels.csv: no model file" in one_line(track_video.main, argv, monkeypatch, capsys)


def test_lists_of_other_lengths_are_refused(show):
    folder, _ = show
    argv = arguments(folder, "train")
    argv.insert(argv.index("--labels"), str(folder / "talk.mp4"))
    with pytest.raises(ValueError, match="one of each"):
        train_tracker.main(argv)


def test_the_same_inputs_give_the_same_bytes(show):
    folder, _ = show
    argv = [*arguments(folder, "train"), "--method", "eigen_points"]
    place = argv.index("--tracker") + 1
    written = []
    for name in ("one.npz", "two.npz"):
        argv[place] = str(folder / name)
        train_tracker.main(argv)
        written.append((folder / name).read_bytes())
    assert written[0] == written[1]
    before = (folder / "talk.parquet").read_bytes()
    track_video.main(arguments(folder, "track", "talk.mp4"))
    assert (folder / "talk.parquet").read_bytes() == before
