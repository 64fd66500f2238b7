"""Every rate through every reader and writer: the same number of frames, the same last time.

A tick is a thousandth of a frame, finer than what any of the formats rounds to.
"""

import json
import re
from fractions import Fraction

import ezc3d
import numpy as np
import other_trackers
import pytest
import recorded_curves
from played_take import RATES, PlayedTake

from bench import format_readers, formats
from stages import (
    export_blender,
    export_maya,
    import_curves,
    import_landmarks,
    import_markers,
)
from stages.files import film, series

COUNT, FIRST = 13, 107
NAMES_TABLE = str(recorded_curves.NAMES_TABLE)


def words(**options):
    return [f"--{name.replace('_', '-')}={value}" for name, value in options.items()]


def agree(read, rate, count=COUNT):
    """Frames, last time and rate are those of the take, to the tick."""
    assert read.rate == rate
    assert len(read.frame) == count
    assert read.frame[-1] - read.frame[0] == count - 1
    assert abs(read.time_s[-1] - float((count - 1) / rate)) < 1e-3 / rate


def c3d(path, points, rate):
    file = ezc3d.c3d()
    point = file["parameters"]["POINT"]
    point["RATE"]["value"], point["UNITS"]["value"] = [float(rate)], ["mm"]
    point["LABELS"]["value"] = ["a", "b"]
    file["data"]["points"] = np.ones((4, 2, len(points)))
    file["data"]["points"][:3] = points.transpose(2, 1, 0)
    file.write(str(path))


def trc(path, points, rate):
    keys = "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame"
    stated = [float(rate), float(rate), len(points), 2, "mm", float(rate), 1, len(points)]
    lines = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}"]
    lines += ["\t".join([*keys.split(), "OrigNumFrames"]), "\t".join(map(str, stated))]
    lines += ["Frame#\tTime\ta\t\t\tb\t\t", "\t\tX1\tY1\tZ1\tX2\tY2\tZ2", ""]
    for frame, row in enumerate(points):
        cells = [frame + 1, f"{float(frame / rate):.5f}", *row.ravel()]
        lines.append("\t".join(map(str, cells)))
    path.write_text("\n".join(lines) + "\n")


def wide(path, points, rate):
    rows = ["frame,time_s,a_x,a_y,a_z,b_x,b_y,b_z"]
    for frame, row in enumerate(points):
        cells = [frame, f"{float(frame / rate):.6f}", *row.ravel()]
        rows.append(",".join(map(str, cells)))
    path.write_text("\n".join(rows) + "\n")


@pytest.mark.parametrize("rate", RATES, ids=str)
@pytest.mark.parametrize(("write", "ending"), [(c3d, "c3d"), (trc, "trc"), (wide, "csv")])
def test_markers(tmp_path, write, ending, rate):
    points = np.random.default_rng(0).uniform(1, 9, (COUNT, 2, 3)).round(3)
    path = tmp_path / f"take.{ending}"
    write(path, points, rate)
    given = {"marker_file": path, "marker_map": "", "unit": "mm", "axes": "x y z", "rate": ""}
    made = {"markers": tmp_path / "a.parquet", "faults": tmp_path / "a.tsv"}
    import_markers.main(words(**given, max_gap_s=0.5, **made))
    agree(series.read(tmp_path / "a.parquet", "markers"), rate)


@pytest.mark.parametrize("rate", RATES, ids=str)
@pytest.mark.parametrize("writer", other_trackers.WRITERS, ids=lambda writer: writer.__name__)
def test_landmarks(tmp_path, writer, rate):
    take = other_trackers.Take(COUNT, rate, lost=(3,))
    tracked = tmp_path / "a.parquet"
    given = ["--landmarks", str(writer(take, tmp_path)), "--maps", *other_trackers.MAPS]
    given += ["--video", take.film(tmp_path / "a.mp4"), "--rate", ""]
    import_landmarks.main([*given, "--tracked", str(tracked)])
    agree(series.read(tracked, "tracked"), rate)


@pytest.mark.parametrize("rate", RATES, ids=str)
@pytest.mark.parametrize("writer", recorded_curves.WRITERS, ids=lambda writer: writer.__name__)
def test_curves(tmp_path, writer, rate):
    # whole milliseconds tell 59.94 from 60 only after some hundred frames
    count = 310 if writer is recorded_curves.mediapipe_csv else COUNT
    take = recorded_curves.Take(count, rate)
    made = {name: tmp_path / f"{name}.parquet" for name in ("curves", "head_motion", "checks")}
    given = {"curve_file": writer(take, tmp_path), "rate": "", "names": NAMES_TABLE}
    import_curves.main(words(**given, **made))
    agree(series.read(made["curves"], "curves"), rate, count)


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_films(tmp_path, rate):
    path = other_trackers.Take(COUNT, rate).film(tmp_path / "a.mp4")
    times = film.picture_times(path)
    assert film.nominal_rate(path) == rate
    assert len(times) == COUNT
    assert abs(times[-1] - float((COUNT - 1) / rate)) < 1e-3 / rate


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_writers(tmp_path, rate):
    take = PlayedTake(tmp_path, "y", rate, FIRST, COUNT)
    made = tmp_path / "made"
    made.mkdir()
    formats.write(made, tmp_path / "rig.npz", tmp_path / "weights.parquet")
    for name, _, read in format_readers.READERS:
        times, positions = read(made)
        assert len(times) == len(positions) == COUNT, name
        assert abs(times[0] - float(FIRST / rate)) < 1e-3 / rate, name
        assert abs(times[-1] - take.last_time) < 1e-3 / rate, name
    for path in [*made.rglob("mesh.json"), made / "obj" / "take.json"]:
        said = json.loads(path.read_text())
        assert Fraction(said["fps_num"], said["fps_den"]) == rate
        assert said["first_frame"] == FIRST


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_scripts(tmp_path, rate):
    take = PlayedTake(tmp_path, "y", rate, FIRST, COUNT)
    scripts = {"blender": tmp_path / "blender.py", "maya": tmp_path / "maya.py"}
    moved = take.options("rig", "weights")
    for name, stage in (("blender", export_blender), ("maya", export_maya)):
        template = formats.TEMPLATES / f"apply_in_{name}.py"
        more = words(anim=tmp_path / "maya.anim") if name == "maya" else []
        stage.main([*moved, *words(template=template, script=scripts[name]), *more])
    for path in scripts.values():
        text = path.read_text()
        assert re.search(rf"\b{rate.numerator}\b", text) and re.search(rf"\b{FIRST}\b", text)
