"""Bad input is answered with one line: file, place and cure; nothing is left behind."""

import os
import re
import subprocess
import sys

import av
import conftest
import numpy as np
import pytest
import tiny_show


def stage(name, folder, *arguments):
    """Run a stage by hand in a show's folder."""
    command = [sys.executable, "-m", f"stages.{name}", *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": str(conftest.PROJECT)}
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, env=environment, check=False
    )


def assert_one_line(run, pattern, output):
    """Check exit code, the line, and that neither the output nor a part of it exists."""
    lines = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert run.returncode == 1, run.stderr
    assert len(lines) == 1 and "Traceback" not in run.stderr, run.stderr
    assert re.search(pattern, lines[0]), lines[0]
    left = [p.name for p in output.parent.iterdir() if output.stem in p.name]
    assert left == []


@pytest.fixture(scope="module")
def footage(tmp_path_factory):
    folder = tmp_path_factory.mktemp("faulty")
    tiny_show.build(folder / "show")
    return folder / "show"


def train(folder, output, video="footage/a.mp4", labels="footage/a.csv"):
    arguments = ["--shots", "a", "--videos", video, "--labels", labels, "--seed", "1"]
    arguments += ["--point-set", "config/point_set.tsv", "--method", "eigen_points"]
    return stage("train_tracker", folder, *arguments, "--tracker", output)


def without(name):
    return lambda text: "".join(x for x in text.splitlines(True) if f"4,{name}" not in x)


def only(frame):
    return lambda text: "".join(
        line for line in text.splitlines(True) if line.startswith(("frame", f"{frame},"))
    )


def moved_out(text):
    return re.sub(r"4,pupil_left,[\d.]+", "4,pupil_left,900", text)


@pytest.mark.parametrize(
    ("change", "pattern"),
    [
        (without("lips_inner"), r"labels\.csv: frame 4: contour lips_inner is missing"),
        (lambda text: text.replace("\n4,", "\n999,"), r"frame 999"),
        (moved_out, r"labels\.csv: frame 4.*pupil_left.*outside"),
        (only(4), r"labels\.csv: .*too few"),
        (lambda text: text.replace("x_px", "x"), r"labels\.csv: unknown column 'x'"),
        (lambda text: "", r"labels\.csv: is empty"),
    ],
)
def test_faulty_labels(footage, tmp_path, change, pattern):
    labels = tmp_path / "labels.csv"
    labels.write_text(change((footage / "footage/a.csv").read_text()))
    output = tmp_path / "tracker.npz"
    assert_one_line(train(footage, output, labels=labels), pattern, output)


def test_labels_that_are_not_there(footage, tmp_path):
    output = tmp_path / "tracker.npz"
    run = train(footage, output, labels="footage/lost.csv")
    assert_one_line(run, r"footage/lost\.csv: no such", output)


def faces_gone(path):
    """Write a film of a wall."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=25)
        stream.width = stream.height = tiny_show.SIZE
        stream.pix_fmt = "yuv420p"
        rng = np.random.default_rng(0)
        for _ in range(20):
            wall = rng.integers(90, 110, (tiny_show.SIZE, tiny_show.SIZE, 3), dtype=np.uint8)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(wall, format="rgb24")))
        container.mux(stream.encode())


def cut_short(path, footage):
    whole = (footage / "footage/b.mp4").read_bytes()
    path.write_bytes(whole[: len(whole) // 2])


@pytest.mark.parametrize(
    ("make", "pattern"),
    [
        (lambda path, footage: faces_gone(path), r"film\.mp4: .*no face"),
        (cut_short, r"film\.mp4: (is cut short|cannot be)"),
        (lambda path, footage: path.write_bytes(b"no film" * 500), r"film\.mp4: cannot be opened"),
        (lambda path, footage: None, r"film\.mp4: no such film"),
    ],
)
def test_faulty_films(finished, footage, tmp_path, make, pattern):
    video, output = tmp_path / "film.mp4", tmp_path / "tracked.parquet"
    make(video, footage)
    tracker = finished.folder / "results/sessions/s1/tracker.npz"
    run = stage("track_video", footage, "--tracker", tracker, "--video", video, "--tracked", output)
    assert_one_line(run, pattern, output)


@pytest.mark.parametrize(
    ("table", "old", "new", "pattern"),
    [
        ("shots", "b\ts1", "a\ts1", r"shots\.tsv: line 3: shot a stands on line 2 already"),
        ("shots", "basis", "base", r"shots\.tsv: unknown column 'base'"),
        ("shots", "b\ts1", "b\ts2", r"shots\.tsv: line 3, column session: 's2' is not in sessions"),
        ("key_shapes", "a\t14", "b\t14", r"key_shapes\.tsv: line 4, column shot: 'b' is not in"),
        ("key_shapes", "\tmouth", "\tnose", r"column region: 'nose' is not in regions\.tsv"),
        ("region_settings", "mouth\t3", "mouth\tx", r"region_settings\.tsv: line 2, column count"),
        ("sessions", "\ta\t0", "\tb\t0", r"column neutral_shot: 'b' is not in shots.tsv with"),
        ("characters", "2 3 0", "2 3", r"characters\.tsv: line 2, column pivot: '2 3' does not"),
        ("config", "seed: 1", "sead: 1", r"config\.yaml: .*'sead' was unexpected"),
    ],
)
def test_faulty_tables_stop_before_any_job(show, table, old, new, pattern):
    path = show.folder / "config" / (f"{table}.yaml" if table == "config" else f"{table}.tsv")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    run = show.snakemake()
    lines = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert run.returncode == 1 and len(lines) == 1, run.stderr
    assert re.search(pattern, lines[0]), lines[0]
    assert "Traceback" not in run.stderr


def test_a_lock_on_a_frame_beyond_the_shot_is_named(show):
    path = show.folder / "config/key_shapes.tsv"
    path.write_text(path.read_text().replace("a\t14", "a\t140", 1))
    run = show.snakemake()
    assert run.returncode == 1
    log = (show.folder / "logs/select_key_shapes/eve.log").read_text()
    assert re.search(r"error: config/key_shapes\.tsv: line 4.*140", log), log


@pytest.mark.parametrize(
    ("change", "pattern"),
    [
        (lambda text: text.replace("v ", "v nan ", 1), r"a_f0009\.obj: vertex 0 is .* not finite"),
        (lambda text: "v 0 0 0\n" + text, r"a_f0009\.obj: has 31 vertices, the neutral has 30"),
        (lambda text: "", r"a_f0009\.obj: "),
    ],
)
def test_a_faulty_sculpt_is_named(show, change, pattern):
    path = show.folder / "plate/sculpts/mouth/a_f0009.obj"
    path.write_text(change(path.read_text()))
    assert show.snakemake().returncode == 1
    log = (show.folder / "logs/assemble_rig/eve/plate.log").read_text()
    assert len(log.splitlines()) == 1
    assert re.search(r"error: plate/sculpts/mouth/" + pattern, log), log
    brief = (show.folder / "results/actors/eve/brief/index.html").read_text()
    assert "1 suspicious" in brief
