from pathlib import Path

import numpy as np
import pytest
from small_take import REGIONS, SmallTake, write_obj

from stages import check_sculpts
from stages.files import sculpt_states


@pytest.fixture
def take(tmp_path):
    return SmallTake(tmp_path, sculpt_error=0.1)


def states(take):
    out = take.folder / "sculpts.parquet"
    check_sculpts.main(take.check_options(out))
    return {(row["region"], row["key_shape"]): row for row in sculpt_states.read(out)}


def path_of(take, region, name):
    return take.folder / "char" / "sculpts" / region / f"{name}.obj"


@pytest.mark.parametrize("seed", range(5))
def test_clean_sculpts_ten_percent_off_are_all_present(tmp_path, seed):
    take = SmallTake(tmp_path, seed=seed, sculpt_error=0.1)
    found = states(take)
    assert list(found) == [(r, name) for r, names in REGIONS.items() for name in names]
    assert [row["state"] for row in found.values()] == ["present"] * len(found)
    assert not any(row["detail"] or row["cure"] for row in found.values())


def test_without_sculpts_all_are_missing_with_the_name_to_save_under(take):
    for path in take.sculpts:
        Path(path).unlink()
    found = states(take)
    assert all(row["state"] == "missing" for row in found.values())
    row = found["eyes", "rom_f0011"]
    assert row["path"] == str(path_of(take, "eyes", "rom_f0011"))
    assert row["path"] in row["cure"]


FAULTS = {
    "other vertices": (lambda v, _: v[:-1], "98 vertices, the neutral has 99"),
    "not finite": (lambda v, _: np.where(np.arange(len(v))[:, None] == 5, np.nan, v), "vertex 5"),
    "millimetres": (lambda v, _: 10 * v, "10 times larger"),
    "metres": (lambda v, _: v / 100, "100 times smaller"),
    "neutral": (lambda _, n: n, "equal to the neutral"),
    "moved": (lambda v, _: v + np.array([0, 3.0, 0]), "moved as a whole"),
    "other axis": (lambda v, _: np.stack([v[:, 0], -v[:, 2], v[:, 1]], axis=1), "axis"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_named_and_nothing_else(take, fault):
    change, words = FAULTS[fault]
    key = "mouth", "rom_f0040"
    write_obj(
        path_of(take, *key), change(take.neutral + take.deltas[key], take.neutral), take.faces[:-9]
    )
    if fault != "other vertices":
        vertices = change(take.neutral + take.deltas[key], take.neutral)
        write_obj(path_of(take, *key), vertices, take.faces)
    found = states(take)
    assert found[key]["state"] == "suspicious"
    assert words in found[key]["detail"]
    assert found[key]["cure"]
    assert [k for k, row in found.items() if row["state"] != "present"] == [key]


def test_another_order_of_vertices_is_suspected_by_the_polygons(take):
    key = "mouth", "rom_f0040"
    order = np.random.default_rng(0).permutation(len(take.neutral))
    place = np.argsort(order)
    faces = [[place[corner] for corner in face] for face in take.faces]
    write_obj(path_of(take, *key), (take.neutral + take.deltas[key])[order], faces)
    row = states(take)[key]
    assert row["state"] == "suspicious"
    assert "polygons are not the neutral's" in row["detail"]


def test_twins_name_each_other_but_not_across_regions(take):
    first, second = (path_of(take, "mouth", name) for name in ("rom_f0003", "rom_f0041"))
    second.write_bytes(first.read_bytes())
    path_of(take, "eyes", "rom_f0011").write_bytes(first.read_bytes())
    found = states(take)
    assert "equal to rom_f0041" in found["mouth", "rom_f0003"]["detail"]
    assert "equal to rom_f0003" in found["mouth", "rom_f0041"]["detail"]
    assert "equal" not in found["eyes", "rom_f0011"]["detail"]


def test_files_that_are_no_key_shapes_are_shown(take):
    stray = path_of(take, "mouth", "rom_f003")
    stray.write_text("v 0 0 0\n")
    assert states(take)["mouth", "rom_f003"]["state"] == "unused"


def test_unreadable_sculpts_and_a_missing_neutral_do_not_stop_it(take):
    path_of(take, "mouth", "rom_f0003").write_bytes(b"\xff\x00 not a mesh")
    assert "no vertices" in states(take)["mouth", "rom_f0003"]["detail"]
    (take.folder / "char" / "neutral.obj").unlink()
    assert all(row["state"] == "missing" for row in states(take).values())


def control_poses(take, error, seed):
    """Sculpt the key shapes as poses of controls in degrees, centimetres and shares."""
    rng = np.random.default_rng(seed)
    folder = take.folder / "sliders"
    scale = np.array([30.0, 30.0, 1.0, 0.1, 1.0, 5.0])
    names = [f"control_{index}" for index in range(6)]
    poses = {}
    for region, row in REGIONS.items():
        for order, name in enumerate(row):
            shape = np.zeros(6)
            shape[order], shape[order + 3] = 1.0, 0.5
            poses[region, name] = shape * scale * (1 + error * rng.normal(size=6))
    for key, values in [(None, np.zeros(6)), *poses.items()]:
        path = (
            folder / "neutral.csv" if key is None else folder / "sculpts" / key[0] / f"{key[1]}.csv"
        )
        path.parent.mkdir(parents=True, exist_ok=True)
        rows = [f"{name},{value}" for name, value in zip(names, values, strict=True)]
        path.write_text("\n".join(["name,value", *rows]) + "\n")
    out = take.folder / "sculpts.parquet"
    options = take.check_options(
        out, neutral=f"{folder}/neutral.csv", sculpt_folder=f"{folder}/sculpts"
    )
    cut = options.index("--sculpts") + 1
    sculpted = [str(path) for path in sorted((folder / "sculpts").rglob("*.csv"))]
    check_sculpts.main([*options[:cut], *sculpted])
    return {(r["region"], r["key_shape"]): r for r in sculpt_states.read(out)}


def test_controls_in_different_units_contradict_nothing(take):
    for seed in range(5):
        found = control_poses(take, error=0.1, seed=seed)
        assert [row["state"] for row in found.values()] == ["present"] * len(found)
