import subprocess
import sys
from fractions import Fraction

import ezc3d
import marker_face
import numpy as np
import pytest

from stages import import_markers
from stages.files import errors, marker_faults_table, series

NAMES = [f"m{number:02d}" for number in range(24)]
# the file's axes: x the subject's right, y into the face, z up
AXES = "-x z -y"
INTO_FILE = np.array([[-1, 0, 0], [0, 0, -1], [0, 1, 0]])


def write(path, points, labels=None, rate=120.0):
    file = ezc3d.c3d()
    point = file["parameters"]["POINT"]
    point["RATE"]["value"], point["UNITS"]["value"] = [rate], ["m"]
    point["LABELS"]["value"] = labels or [f"Jo:{name}" for name in NAMES]
    file["data"]["points"] = np.ones((4, points.shape[1], len(points)))
    file["data"]["points"][:3] = (points @ INTO_FILE.T / 1000).transpose(2, 1, 0)
    file.write(str(path))
    return path


def options(folder, **changes):
    chosen = {
        "marker-file": str(folder / "take.c3d"),
        "marker-map": "",
        "unit": "file",
        "axes": AXES,
        "rate": "",
        "max-gap-s": "0.5",
        "markers": str(folder / "markers.parquet"),
        "faults": str(folder / "faults.tsv"),
    } | {name.replace("_", "-"): value for name, value in changes.items()}
    return [f"--{name}={value}" for name, value in chosen.items()]


def imported(folder, names=NAMES):
    read = series.read(folder / "markers.parquet", "markers")
    points = series.stack(read, folder / "markers.parquet", names, "xyz")
    repaired = np.stack([read.columns[f"{name}.repaired"] for name in names], axis=1)
    faults = marker_faults_table.read(folder / "faults.tsv")
    return read, points, repaired, faults


@pytest.fixture(scope="module")
def faulty():
    """The truth, the take and what is wrong with it."""
    truth, take = marker_face.take(seed=9, count=600)
    take[100:130, 4] = np.nan
    take[300:400, 5] = np.nan
    take[200:260, [7, 13]] = take[200:260, [13, 7]]
    take[450:453, 20] += [0, 12, 0]
    take[:, 23] = np.nan
    return truth, take


def test_a_take_comes_in_with_the_shows_names_unit_axes_and_repairs(tmp_path, faulty):
    truth, take = faulty
    write(tmp_path / "take.c3d", take)
    (tmp_path / "map.tsv").write_text("marker\tname\nJo:m00\tchin\nm01\t\n")
    import_markers.main(options(tmp_path, marker_map=str(tmp_path / "map.tsv")))
    names = ["chin", *NAMES[2:]]
    read, points, repaired, faults = imported(tmp_path, names)
    assert (read.rate, read.meta["units"], read.meta["markers"]) == (Fraction(120), "mm", names)
    assert "m01.x" not in read.columns
    rows = [(f.marker, f.first_frame, f.last_frame, f.fault, f.cure) for f in faults]
    assert rows == [
        ("m04", 100, 129, "gap", "filled"),
        ("m05", 300, 399, "gap", "left"),
        ("m07", 200, 259, "swap", "replaced"),
        ("m13", 200, 259, "swap", "replaced"),
        ("m20", 450, 452, "jump", "replaced"),
        ("m23", 0, 599, "missing", "left"),
    ]
    expected = np.zeros((600, 24), int)
    expected[100:130, 4] = 1
    expected[200:260, [7, 13]] = 2
    expected[450:453, 20] = 2
    np.testing.assert_array_equal(repaired, np.delete(expected, 1, axis=1))
    away = np.linalg.norm(points - np.delete(truth, 1, axis=1), axis=2)
    assert np.nanmax(away) < 1.5
    lost = np.isnan(away)
    assert lost[:, 22].all()
    assert lost[300:400, 4].all()
    assert lost.sum() == 700
    seen = np.delete(np.isfinite(take[..., 0]) & (expected == 0), 1, axis=1)
    np.testing.assert_allclose(read.columns["confidence"], seen.mean(axis=1), atol=1e-6)


def test_the_same_take_gives_the_same_bytes(tmp_path, faulty):
    write(tmp_path / "take.c3d", faulty[1])
    contents = []
    for _ in range(2):
        import_markers.main(options(tmp_path))
        contents.append([(tmp_path / n).read_bytes() for n in ("markers.parquet", "faults.tsv")])
    assert contents[0] == contents[1]


def test_a_table_of_one_marker_comes_in(tmp_path):
    (tmp_path / "a.csv").write_text("a_x;a_y;a_z\n1,5;2;3\nNA;NA;NA\n2,5;2;3\n")
    given = {"marker_file": str(tmp_path / "a.csv"), "unit": "cm", "axes": "x y z", "rate": "50"}
    import_markers.main(options(tmp_path, **given))
    read, points, _, faults = imported(tmp_path, ["a"])
    np.testing.assert_allclose(points[:, 0], [[15, 20, 30], [np.nan] * 3, [25, 20, 30]])
    np.testing.assert_allclose(read.time_s, [0, 0.02, 0.04])
    assert [tuple(fault) for fault in faults] == [("a", 1, 1, "gap", "left")]


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"unit": "ell"}, "--unit: 'ell' is no unit"),
        ({"axes": "x y"}, "--axes: 'x y' are not three axes"),
        ({"rate": "100"}, r"take\.c3d: is of 120 Hz by POINT:RATE.*, not of 100 Hz"),
        ({"max_gap_s": "-1"}, "--max-gap-s: -1.0 s: give 0 or more"),
        ({"max_gap_s": "nan"}, "--max-gap-s: nan s: give 0 or more"),
    ],
)
def test_wrong_settings_are_named(tmp_path, changes, fault):
    write(tmp_path / "take.c3d", marker_face.take(count=5)[1])
    with pytest.raises(errors.InputError, match=fault):
        import_markers.main(options(tmp_path, **changes))
    assert not (tmp_path / "markers.parquet").exists()


def test_a_take_in_which_nothing_is_seen_is_refused(tmp_path):
    write(tmp_path / "take.c3d", np.full((6, 24, 3), np.nan))
    with pytest.raises(errors.InputError, match="holds no marker that is ever seen"):
        import_markers.main(options(tmp_path))


def test_bad_takes_end_in_one_line(tmp_path):
    path = write(tmp_path / "take.c3d", marker_face.take(count=60)[1])
    whole = path.read_bytes()
    (tmp_path / "map.tsv").write_text("marker\tname\nforehead\tbrow\n")
    cases = [
        (whole[:5000], "", "take.c3d: is cut short"),
        (b"PathFileType\t4\n", "", "take.c3d: is no C3D file"),
        (whole, str(tmp_path / "map.tsv"), "map.tsv: names marker 'forehead'"),
    ]
    for content, marker_map, fault in cases:
        path.write_bytes(content)
        words = options(tmp_path, marker_map=marker_map)
        command = [sys.executable, "-m", "stages.import_markers", *words]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        last = run.stderr.splitlines()[-1]
        assert run.returncode == 1
        assert last.startswith("error: ")
        assert fault in last
        assert "Traceback" not in run.stderr
