import ezc3d
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from stages.files import c3d_parameters, errors, marker_file, marker_units

COORDINATES = st.floats(-2000, 2000, width=32).map(lambda value: value or 1.0)


def takes(markers=4, most=6):
    """Draw points (T, P, 3) float32 in which some markers are missing."""
    shapes = st.tuples(st.integers(1, most), st.integers(1, markers), st.just(3))
    whole = shapes.flatmap(lambda shape: hnp.arrays(np.float32, shape, elements=COORDINATES))
    return whole.flatmap(
        lambda points: hnp.arrays(bool, points.shape[:2]).map(
            lambda lost: np.where(lost[..., None], np.nan, points).astype(np.float32)
        )
    )


def write_c3d(path, points, labels=None, rate=120.0, unit="mm", residual=0.0, **parameters):
    file = ezc3d.c3d()
    count, markers, _ = points.shape
    point = file["parameters"]["POINT"]
    point["RATE"]["value"], point["UNITS"]["value"] = [rate], [unit]
    point["LABELS"]["value"] = labels or [f"m{number}" for number in range(markers)]
    file["data"]["points"] = np.ones((4, markers, count))
    file["data"]["points"][:3] = points.transpose(2, 1, 0)
    file["data"]["meta_points"]["residuals"] = np.full((1, markers, count), residual)
    file["data"]["meta_points"]["residuals"][0, np.isnan(points[..., 0]).T] = -1
    for name, value in parameters.items():
        file.add_parameter(*name.split("__"), value)
    file.write(str(path))
    return path


def cell(value, decimal="."):
    return "" if np.isnan(value) else repr(float(value)).replace(".", decimal)


def write_trc(path, points, names, rate=60.0, step=None, **changes):
    count, markers, _ = points.shape
    stated = {
        "DataRate": rate, "CameraRate": rate, "NumFrames": count, "NumMarkers": markers,
        "Units": "cm", "OrigDataRate": rate, "OrigDataStartFrame": 1, "OrigNumFrames": count,
    } | changes  # fmt: skip
    lines = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}", "\t".join(stated)]
    lines.append("\t".join(str(value) for value in stated.values()))
    lines.append("Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t")
    lines.append("\t\t" + "\t".join(f"{a}{n + 1}" for n in range(markers) for a in "XYZ"))
    lines.append("")
    for t, row in enumerate(points):
        time = t * (step or 1 / rate)
        lines.append("\t".join([str(t + 1), f"{time:.5f}", *(cell(v) for v in row.ravel())]))
    path.write_text("\n".join(lines) + "\n")
    return path


@settings(max_examples=25, deadline=None)
@given(takes())
def test_c3d_comes_back_as_an_independent_writer_wrote_it(tmp_path_factory, points):
    path = write_c3d(tmp_path_factory.mktemp("c3d") / "a.c3d", points, unit="m")
    read = marker_file.read(path)
    np.testing.assert_array_equal(read.points, points)
    assert read.names == [f"m{number}" for number in range(points.shape[1])]
    assert (read.unit, set(read.rates.values())) == ("m", {120.0})


def test_c3d_codes_of_missing_points(tmp_path):
    points = np.full((5, 3, 3), 7.0, np.float32)
    points[1, 0], points[2, 1] = np.nan, 0.0
    path = write_c3d(tmp_path / "a.c3d", points)
    read = marker_file.read(path).points
    lost = np.isnan(read).all(axis=2)
    assert lost.sum() == 2
    assert lost[1, 0]
    assert lost[2, 1]


def test_c3d_analog_samples_and_more_labels_than_one_parameter_holds(tmp_path):
    points = np.arange(4 * 300 * 3, dtype=np.float32).reshape(4, 300, 3) + 1
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100]
    labels = [f"m{number}" for number in range(300)]
    file["parameters"]["POINT"]["LABELS"]["value"] = labels
    file["parameters"]["ANALOG"]["RATE"]["value"] = [500]
    file["parameters"]["ANALOG"]["LABELS"]["value"] = ["a", "b"]
    file["data"]["points"] = np.ones((4, 300, 4))
    file["data"]["points"][:3] = points.transpose(2, 1, 0)
    file["data"]["analogs"] = np.random.default_rng(0).standard_normal((1, 2, 20))
    file.write(str(tmp_path / "a.c3d"))
    read = marker_file.read(tmp_path / "a.c3d")
    np.testing.assert_array_equal(read.points, points)
    assert read.names == labels


def test_c3d_of_whole_numbers(tmp_path):
    points = np.round(np.random.default_rng(0).uniform(-900, 900, (3, 2, 3)), 1)
    path = write_c3d(tmp_path / "a.c3d", points)
    content = bytearray(path.read_bytes())
    start = (int.from_bytes(content[16:18], "little") - 1) * 512
    content[12:16] = np.float32(0.1).tobytes()
    place = content.index(b"SCALE") + 5
    content[place + 4 : place + 8] = np.float32(0.1).tobytes()
    numbers = np.zeros((3, 2, 4), "<i2")
    numbers[..., :3] = np.rint(points / 0.1)
    numbers[1, 1, 3] = -1
    path.write_bytes(bytes(content[:start]) + numbers.tobytes())
    points[1, 1] = np.nan
    np.testing.assert_allclose(marker_file.read(path).points, points, atol=1e-4)


@pytest.mark.parametrize("stated", [True, False])
def test_c3d_longer_than_its_counter(tmp_path, stated):
    count = 65_536 + 700
    points = np.arange(1, 3 * count + 1, dtype=np.float32).reshape(count, 1, 3)
    fields = {"TRIAL__ACTUAL_START_FIELD": [1, 0], "TRIAL__ACTUAL_END_FIELD": [700, 1]}
    path = write_c3d(tmp_path / "a.c3d", points, **(fields if stated else {}))
    np.testing.assert_array_equal(marker_file.read(path).points, points)


def test_c3d_cut_anywhere_is_refused_in_one_line(tmp_path):
    points = np.random.default_rng(0).uniform(1, 9, (30, 5, 3))
    content = write_c3d(tmp_path / "whole.c3d", points).read_bytes()
    start = (int.from_bytes(content[16:18], "little") - 1) * 512
    path = tmp_path / "cut.c3d"
    for length in [*range(0, start, 13), *range(start, start + 30 * 80, 79)]:
        path.write_bytes(content[:length])
        with pytest.raises(errors.InputError, match=r"cut\.c3d: .*(cut short|damaged)"):
            marker_file.read(path)


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 1535), st.integers(0, 255)), min_size=1, max_size=6))
def test_damaged_c3d_is_read_or_refused(tmp_path_factory, changes):
    folder = tmp_path_factory.mktemp("damaged")
    content = bytearray(write_c3d(folder / "a.c3d", np.ones((8, 3, 3))).read_bytes())
    for place, value in changes:
        content[place] = value
    (folder / "a.c3d").write_bytes(bytes(content))
    try:
        take = marker_file.read(folder / "a.c3d")
    except errors.InputError as error:
        assert "\n" not in str(error)
    else:
        assert take.points.nbytes < 10 * len(content)


@pytest.mark.parametrize("kind", [4, 2, -1, 9])
@pytest.mark.parametrize("shape", [(255,) * 9, (255, 255), (200,), (0, 3)])
def test_c3d_parameters_that_promise_too_much_are_refused(kind, shape):
    parameter = b"\x01\x01A\x00\x00" + bytes([kind % 256, len(shape), *shape]) + b"\x00" * 40
    if 0 in shape:
        assert c3d_parameters.read("a.c3d", parameter) == {":A": []}
    else:
        with pytest.raises(errors.InputError, match="a.c3d: its parameter section is damaged"):
            c3d_parameters.read("a.c3d", parameter)


@settings(max_examples=25, deadline=None)
@given(takes())
def test_trc_comes_back(tmp_path_factory, points):
    names = [f"Head:m {number}" for number in range(points.shape[1])]
    path = write_trc(tmp_path_factory.mktemp("trc") / "a.trc", points, names)
    read = marker_file.read(path)
    np.testing.assert_array_equal(read.points, points)
    assert (read.names, read.unit, read.rates["DataRate"]) == (names, "cm", 60.0)


@settings(max_examples=40, deadline=None)
@given(
    takes(),
    st.sampled_from([",", ";", "\t"]),
    st.sampled_from(["{}_x", "{}.Y", "{}:z", "{} X"]),
    st.sampled_from(["", "NA", "nan", "-"]),
    st.randoms(use_true_random=False),
)
def test_wide_tables_come_back(tmp_path_factory, points, separator, spelling, gap, random):
    count, markers, _ = points.shape
    columns = {"Frame": [str(t + 11) for t in range(count)], "Stimulus type": ["x"] * count}
    decimal = "." if separator == "," else random.choice(".,")
    for p in range(markers):
        for axis, letter in enumerate("xyz"):
            name = spelling.format(f"m_{p}")[:-1] + (letter if p % 2 else letter.upper())
            columns[name] = [cell(v, decimal) or gap for v in points[:, p, axis]]
    order = list(columns)
    random.shuffle(order)
    rows = [order, *([columns[name][t] for name in order] for t in range(count))]
    path = tmp_path_factory.mktemp("csv") / "a.csv"
    path.write_text("".join(separator.join(row) + "\n" for row in rows), encoding="utf-8-sig")
    read = marker_file.read(path)
    assert sorted(read.names) == [f"m_{p}" for p in range(markers)]
    ordered = read.points[:, [read.names.index(f"m_{p}") for p in range(markers)]]
    np.testing.assert_array_equal(ordered, points)
    assert "Stimulus type" in read.notes[0]


def test_rows_that_a_table_leaves_out_are_gaps(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("time_ms,a_x,a_y,a_z\n0,1,1,1\n10,2,2,2\n40,5,5,5\n50,6,6,6\n")
    read = marker_file.read(path)
    np.testing.assert_array_equal(read.points[:, 0, 0], [1, 2, np.nan, np.nan, 5, 6])
    assert read.rates["its times"] == pytest.approx(100)


def test_rounded_times_do_not_drift(tmp_path):
    path = tmp_path / "a.csv"
    rows = "".join(f"{frame / 120:.3f},{frame + 1},1,1\n" for frame in range(900))
    path.write_text("time,a_x,a_y,a_z\n" + rows)
    read = marker_file.read(path)
    np.testing.assert_array_equal(read.points[:, 0, 0], np.arange(1, 901))
    assert str(marker_units.rate(path, read, "")) == "120"


def test_a_marker_in_the_origin_throughout_is_no_gap(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("frame,a_x,a_y,a_z,b_x,b_y,b_z\n1,0,0,0,1,1,1\n2,0,0,0,0,0,0\n")
    points = marker_file.read(path).points
    assert (points[:, 0] == 0).all()
    assert np.isnan(points[1, 1]).all()


HEADER = "frame,a_x,a_y,a_z\n"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "is empty"),
        ("frame,a_x,a_y\n1,2,3\n", "marker 'a' has no column z"),
        ("frame,b,c\n1,2,3\n", "names no marker in its first line"),
        ("a_x,a_y,a_z,A_x,a.X\n", "two columns hold x of marker 'a'"),
        (HEADER, "holds no row of numbers"),
        (HEADER + "1,2,3,4\n2,2,3\n", "line 3 has 3 cells, the header has 4: is it cut short"),
        (HEADER + "1,2,three,4\n", "line 2, column a_y: 'three' is no number"),
        (HEADER + "1,2,inf,4\n", "line 2, column a_y: 'inf' is no number"),
        (HEADER + "1,2,3,-1e39\n", "line 2, column a_z: '-1e39' is no number"),
        (HEADER + "1,2,3,4\n,2,3,4\n", "line 3 lacks its frame"),
        (HEADER + "1,2,3,4\n1,2,3,4\n", "line 3: its frame number does not follow"),
        (HEADER + "1,2,3,4\n90000000,2,3,4\n", "2 rows stand for 90000000 frames"),
        (
            "time," + HEADER[6:] + "0,1,1,1\n1,1,1,1\n2.4,1,1,1\n3,1,1,1\n",
            "lies between the frames",
        ),
    ],
)
def test_faulty_tables_are_named_with_their_place(tmp_path, text, fault):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(errors.InputError, match=rf"a\.csv: .*{fault}"):
        marker_file.read(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"NumFrames": 9}, "is cut short: 3 of 9 promised frames"),
        ({"NumMarkers": 3}, "has 2 labels, NumMarkers is 3"),
        ({"DataRate": "fast"}, "line 3: DataRate is no number above 0"),
        ({"Units": ""}, "line 3 lacks Units"),
    ],
)
def test_faulty_trc_is_named(tmp_path, changes, fault):
    path = write_trc(tmp_path / "a.trc", np.ones((3, 2, 3)), ["a", "b"], **changes)
    with pytest.raises(errors.InputError, match=rf"a\.trc: .*{fault}"):
        marker_file.read(path)


def test_files_of_another_kind_are_refused(tmp_path):
    text = write_trc(tmp_path / "a.trc", np.ones((3, 1, 3)), ["a"]).read_text()
    binary = write_c3d(tmp_path / "a.c3d", np.ones((3, 1, 3))).read_bytes()
    for name, content, fault in [
        ("b.c3d", text.encode(), "is no C3D file"),
        ("b.trc", binary, "no table of UTF-8 text|begins with"),
        ("b.csv", binary, "no table of UTF-8 text|names no marker"),
        ("c.csv", text.encode(), "names no marker"),
        ("b.fbx", binary, "is no marker file by its name"),
        ("d.trc", text.encode()[:60], "ends within its header|lacks"),
    ]:
        (tmp_path / name).write_bytes(content)
        with pytest.raises(errors.InputError, match=fault) as raised:
            marker_file.read(tmp_path / name)
        assert "\n" not in str(raised.value)
    with pytest.raises(errors.InputError, match="no such marker file"):
        marker_file.read(tmp_path / "none.c3d")
    write_c3d(tmp_path / "a.c3d", np.ones((3, 2, 3)), ["a", "a"])
    with pytest.raises(errors.InputError, match="two markers are labelled 'a'"):
        marker_file.read(tmp_path / "a.c3d")
