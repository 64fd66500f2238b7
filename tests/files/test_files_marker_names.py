import numpy as np
import pytest

from stages.files import errors, marker_map, marker_take, marker_units


def write_map(path, *rows):
    path.write_text("marker\tname\n" + "".join(f"{row}\n" for row in rows))
    return path


def test_maps_rename_and_leave_out(tmp_path):
    path = write_map(tmp_path / "map.tsv", "Jo:lip.up\tlip_up", "*12\t", "chin\tjaw")
    mapped = marker_map.read(path)
    labels = ["Jo:lip.up", "*12", "Jo:chin", "Jo:nose"]
    kept = marker_map.apply("a.c3d", labels, path, mapped)
    assert kept == {0: "lip_up", 2: "jaw", 3: "nose"}


@pytest.mark.parametrize(
    ("rows", "fault"),
    [
        (["a\tx.y"], "line 2: name 'x.y' holds a dot, colon or slash"),
        (["a\tx", "a\ty"], "line 3: marker 'a' is blank or stands twice"),
        (["nose\tx"], r"names marker 'nose', which a\.c3d lacks \(1 such rows\)"),
        (["a\tb"], "two markers would be named 'b'"),
        (["a\t", "b\t", "c/d\t"], r"leaves no marker of a\.c3d"),
        (["a\tx"], "marker 'c/d' holds a dot or slash: rename it"),
    ],
)
def test_faulty_maps_are_named(tmp_path, rows, fault):
    path = write_map(tmp_path / "map.tsv", *rows)
    with pytest.raises(errors.InputError, match=fault):
        marker_map.apply("a.c3d", ["a", "b", "c/d"], path, marker_map.read(path))


def take_of(count=1000, **rates):
    named = {place.replace("_", " "): rate for place, rate in rates.items()}
    return marker_take.MarkerTake(["a"], np.zeros((count, 1, 3), np.float32), "", named)


@pytest.mark.parametrize(
    ("rates", "wanted", "expected"),
    [
        ({"header": 120.0}, "", "120"),
        ({"header": 119.88012}, "", "120000/1001"),
        ({"header": 29.97003}, "", "30000/1001"),
        ({"header": 100.0, "its_times": 100.0004}, "", "100"),
        ({"header": 100.0, "its_times": 120.0}, "120", "120"),
        ({"header": 120.0, "POINT": 100.0}, "100", "100"),
        ({}, "30000/1001", "30000/1001"),
        ({"its_times": 59.995}, "", "60"),
    ],
)
def test_rates_that_agree(rates, wanted, expected):
    assert str(marker_units.rate("a", take_of(**rates), wanted)) == expected


@pytest.mark.parametrize(
    ("rates", "wanted", "fault"),
    [
        ({}, "", "states no rate and no times"),
        ({"header": 120.0, "its_times": 100.0}, "", "contradicts itself, 120 Hz by header, 100 Hz"),
        ({"header": 120.0, "its_times": 100.0}, "120", "is of 100 Hz by its times, not of 120"),
        ({"header": 120.0}, "60", "is of 120 Hz by header, not of 60 Hz"),
        ({"header": 120.0}, "fast", "'fast' is no rate"),
    ],
)
def test_rates_that_contradict_each_other(rates, wanted, fault):
    with pytest.raises(errors.InputError, match=fault):
        marker_units.rate("a", take_of(**rates), wanted)


def test_units_and_axes():
    assert marker_units.millimetres("a", "file", " Metres ") == 1000
    assert marker_units.millimetres("a", "inch", "mm") == 25.4
    assert marker_units.millimetres("a", "187.5", "") == 187.5
    np.testing.assert_array_equal(marker_units.axes("x z -y") @ [1, 2, 3], [1, 3, -2])
    np.testing.assert_array_equal(marker_units.axes("-x,y,+z"), np.diag([-1, 1, 1]))
    for wanted, stated, fault in [
        ("file", "", "a: states no unit"),
        ("file", "furlong", "a: states the unit 'furlong'"),
        ("-3", "", "--unit: '-3' is no unit"),
        ("nan", "", "--unit: 'nan' is no unit"),
    ]:
        with pytest.raises(errors.InputError, match=fault):
            marker_units.millimetres("a", wanted, stated)
    for text in ("x y", "x y y", "x y z z", "x, y; z", "xxyz", "a b c", ""):
        with pytest.raises(errors.InputError, match="are not three axes"):
            marker_units.axes(text)
