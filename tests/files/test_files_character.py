"""Masks, tables of controls, rigs, sculpts' states and weights."""

from fractions import Fraction

import numpy as np
import pytest

from stages.core import local_shapes, masks
from stages.files import controls, errors, mask_table, rig, sculpt_states, sculpts, weights

NAMES = [str(vertex) for vertex in range(6)]


def table(tmp_path, text):
    path = tmp_path / "masks.tsv"
    path.write_text(text)
    return path


def test_masks_by_vertices(tmp_path):
    path = table(tmp_path, "vertex\tregion\tweight\n0\ta\t1\n2\tb\t0.25\n2\ta\t0.75\n")
    read = mask_table.read(path, NAMES, 3)
    assert read.regions == ["a", "b"]
    np.testing.assert_allclose(read.given, [[1, 0, 0.75, 0, 0, 0], [0, 0, 0.25, 0, 0, 0]])


def test_masks_by_ramps_with_listed_vertices(tmp_path):
    path = table(
        tmp_path,
        "region\taxis\tfrom\tto\tvertices\n"
        "mouth\t\t\t\t\neyes\ty\t-0.5\t1\t\npupils\t\t\t\t1-2, 5\n",
    )
    read = mask_table.read(path, NAMES, 3)
    assert (read.regions, read.rest, read.ramps) == (
        ["mouth", "eyes", "pupils"],
        0,
        [(1, 1, -0.5, 1.0)],
    )
    assert read.listed == [(2, [1, 2, 5])]
    heights = np.array([-1, 0, 0.25, 0.25, 2, 2.0])
    points = np.stack([0 * heights, heights, 0 * heights], axis=1)
    values = masks.by_ramps(points, 3, read.rest, read.ramps, read.listed)
    np.testing.assert_allclose(values[1], [0, 0, 0, 0.5, 1, 0])
    np.testing.assert_allclose(values[2], [0, 1, 1, 0, 0, 1])
    np.testing.assert_allclose(values.sum(axis=0), 1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("vertex\tregion\tweight\n9\ta\t1\n", "line 2: no vertex '9': they run from 0 to 5"),
        ("vertex\tregion\tweight\n0\ta\t1\n0\ta\t1\n", "line 3: vertex 0 stands twice in a"),
        ("vertex\tregion\tweight\n0\ta\tx\n", "line 2, column weight: 'x' is not a number"),
        ("vertex\tregion\tweight\n", "lists no vertex"),
        ("region\taxis\tfrom\tto\na\t\t\t\nb\tw\t0\t1\n", "line 3, column axis: 'w'"),
        ("region\taxis\tfrom\tto\na\t\t\t\nb\ty\t1\t1\n", "line 3: from and to are both 1"),
        ("region\taxis\tfrom\tto\na\t\t\t\nb\ty\t\t1\n", "line 3, column from: '' is not a number"),
        ("region\taxis\tfrom\tto\nb\ty\t0\t1\n", "no row without heights"),
        ("region\taxis\tfrom\tto\na\t\t\t\na\t\t\t\n", "line 2: one row for each region"),
        (
            "region\taxis\tfrom\tto\tvertices\na\t\t\t\t\nb\t\t\t\t4-9\n",
            "line 3.*'4-9' is not within 0-5",
        ),
        ("region\taxis\tfrom\tto\tvertices\na\t\t\t\t\nb\t\t\t\tx\n", "line 3.*no range"),
        ("region\tfoo\na\tb\n", "unknown column 'foo'"),
    ],
)
def test_faults_of_masks_are_named(tmp_path, text, message):
    with pytest.raises(errors.InputError, match=message):
        mask_table.read(table(tmp_path, text), NAMES, 3)


def test_a_table_of_controls_keeps_its_order_and_names_its_faults(tmp_path):
    path = tmp_path / "pose.csv"
    path.write_text("name,value\njaw,1.5\ncurve.cv[3].x,-2\n")
    pose = controls.read(path)
    assert list(pose.items()) == [("jaw", 1.5), ("curve.cv[3].x", -2.0)]
    assert controls.in_order(path, pose, ["curve.cv[3].x", "jaw"]) == [-2.0, 1.5]
    with pytest.raises(errors.InputError, match="control lid of the neutral is missing"):
        controls.in_order(path, pose, ["jaw", "lid", "curve.cv[3].x"])
    with pytest.raises(errors.InputError, match=r"the neutral has no control curve\.cv"):
        controls.in_order(path, pose, ["jaw"])
    for text, message in (
        ("name,value\njaw,1\njaw,2\n", "line 3: control 'jaw' stands twice"),
        ("name,value\njaw,nan\n", "line 2, column value: 'nan' is not a number"),
        ("name,value\ntime_s,1\n", "line 2: a control cannot be called 'time_s'"),
        ("name,value\n", "names no control"),
    ):
        path.write_text(text)
        with pytest.raises(errors.InputError, match=message):
            controls.read(path)


def tiny_rig(controls_names=()):
    dimensions = 1 if controls_names else 3
    rng = np.random.default_rng(0)
    return rig.Rig(
        names=["a.s1", "b.s2"],
        mask_names=["a", "b"],
        controls=list(controls_names),
        neutral=rng.normal(size=(4, dimensions)),
        deltas=local_shapes.gather(rng.normal(size=(2, 4, dimensions))),
        masks=np.array([[1, 1, 0.5, 0], [0, 0, 0.5, 1]]),
        mask_index=np.array([0, 1], np.int32),
        sizes=np.array([4], np.int32),
        corners=np.arange(4, dtype=np.int32),
        colours=np.zeros((0, 3)),
        pivot=np.array([0.0, -1.0, 0.5]),
        unit="cm",
        up_axis="z",
        face_unit=6.5,
    )


def test_a_rig_comes_back_as_it_was_and_says_its_form(tmp_path):
    path = tmp_path / "rig.npz"
    for made, form in ((tiny_rig(), "mesh"), (tiny_rig("wxyz"), "controls")):
        rig.write(path, made)
        read = rig.read(path, form)
        for name in rig.ARRAYS:
            np.testing.assert_array_equal(getattr(read, name), getattr(made, name))
        for name in rig.SHAPES:
            np.testing.assert_array_equal(getattr(read.deltas, name), getattr(made.deltas, name))
        for name in rig.HEADER:
            assert getattr(read, name) == getattr(made, name)
        other = {"mesh": "controls", "controls": "mesh"}[form]
        with pytest.raises(errors.InputError, match=f"form '{form}', expected '{other}'"):
            rig.read(path, other)


def test_the_vertex_hash_tells_order_and_polygons():
    made = tiny_rig()
    hashes = {rig.vertex_hash(made)}
    made.neutral[[0, 1]] = made.neutral[[1, 0]]
    hashes.add(rig.vertex_hash(made))
    made.corners[[0, 1]] = made.corners[[1, 0]]
    hashes.add(rig.vertex_hash(made))
    assert len(hashes) == 3


def test_weights_come_back_by_name_in_parquet_and_csv(tmp_path):
    rng = np.random.default_rng(0)
    columns = {"a.s1": rng.normal(size=5), "b.s2": rng.normal(size=5), "confidence": np.ones(5)}
    turns = np.tile([0, 0, 0.6, 0.8], (5, 1))
    rest = np.tile([1, 2, 3, 1.1], (5, 1))
    columns |= weights.head_columns(turns, rest)
    path, text = tmp_path / "w.parquet", tmp_path / "w.csv"
    weights.write(path, text, np.arange(10, 15), columns, Fraction(30000, 1001))
    read = weights.read(path, ["b.s2", "a.s1"])
    expected = np.stack([columns["b.s2"], columns["a.s1"]], axis=1).astype(np.float32)
    np.testing.assert_array_equal(read.shapes, expected)
    np.testing.assert_allclose(read.rotation, turns, rtol=1e-6)
    np.testing.assert_allclose(np.c_[read.translation, read.scale], rest, rtol=1e-6)
    lines = [line.split(",") for line in text.read_text().splitlines()]
    assert lines[0][:4] == ["frame", "time_s", "a.s1", "b.s2"]
    assert lines[1][:2] == ["10", f"{10 * 1001 / 30000:.6f}"]
    np.testing.assert_array_equal(
        np.array([line[2] for line in lines[1:]], np.float32), columns["a.s1"].astype(np.float32)
    )
    with pytest.raises(errors.InputError, match=r"column c\.s3 is missing"):
        weights.read(path, ["c.s3"])
    columns["b.s2"] = np.where(np.arange(5) == 2, np.nan, 0.0)
    weights.write(path, text, np.arange(10, 15), columns, Fraction(30))
    with pytest.raises(errors.InputError, match=r"frame 12, column b\.s2: not finite"):
        weights.read(path, ["a.s1", "b.s2"])


def test_states_come_back_and_several_faults_stand_together(tmp_path):
    path = sculpts.path_of("char/sculpts", "mouth", "rom_f0001", "char/neutral.obj")
    assert path.as_posix() == "char/sculpts/mouth/rom_f0001.obj"
    states = sculpt_states.StateTable({("mouth", "rom_f0001"): path})
    states.set(("mouth", "rom_f0001"), "suspicious", "one", "mend it")
    states.set(("mouth", "rom_f0001"), "suspicious", "two", "mend that")
    states.add_unused([path, "char/sculpts/mouth/typo.obj"])
    sculpt_states.write(tmp_path / "s.parquet", list(states.rows.values()))
    rows = sculpt_states.read(tmp_path / "s.parquet")
    assert [row["state"] for row in rows] == ["suspicious", "unused"]
    assert rows[0]["detail"] == "one; two"
    assert rows[0]["cure"] == "mend it; mend that"
    assert rows[1]["key_shape"] == "typo"
