from pathlib import Path

import numpy as np
import pytest
from small_take import REGIONS, SmallTake, words, write_obj

from stages import assemble_rig, bake_controls, smooth_weights
from stages.core import local_shapes
from stages.files import errors, rig, series

TOTAL = sum(map(len, REGIONS.values()))


@pytest.fixture
def take(tmp_path):
    return SmallTake(tmp_path)


def assembled(take, **changed):
    assemble_rig.main(take.rig_options(**changed))
    return rig.read_any(take.folder / "rig.npz")


def test_the_rig_holds_what_was_sculpted_in_the_files_order(take):
    made = assembled(take)
    assert made.names == [f"{region}.{name}" for region, names in REGIONS.items() for name in names]
    np.testing.assert_allclose(made.neutral, take.neutral, atol=1e-8)
    np.testing.assert_allclose(
        local_shapes.dense(made.deltas), list(take.deltas.values()), atol=1e-8
    )
    np.testing.assert_allclose(made.masks.sum(axis=0), 1.0)
    assert [made.mask_names[row] for row in made.mask_index] == ["mouth"] * 3 + ["eyes"] * 2
    np.testing.assert_array_equal(made.pivot, [1, -8, 0.5])


def test_gaps_are_counted_and_the_first_is_named(take):
    missing = take.folder / "char" / "sculpts" / "mouth" / "rom_f0040.obj"
    missing.unlink()
    with pytest.raises(errors.InputError, match=rf"1 of {TOTAL} sculpts missing.*{missing}.*brief"):
        assembled(take)
    for path in take.sculpts:
        Path(path).unlink()
    with pytest.raises(errors.InputError, match=rf"{TOTAL} of {TOTAL} sculpts missing"):
        assembled(take)
    assert not (take.folder / "rig.npz").exists()


def test_a_sculpt_with_other_vertices_is_named(take):
    path = take.folder / "char" / "sculpts" / "eyes" / "rom_f0012.obj"
    write_obj(path, take.neutral[:-1], [])
    with pytest.raises(errors.InputError, match=rf"{path}: has 98 vertices, the neutral has 99"):
        assembled(take)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("vertex\tregion\tweight\n0\tmouth\t1\n1\teyes\t1\n", r"vertex 2: .*sum to 0.*not listed"),
        ("region\taxis\tfrom\tto\nmouth\t\t\t\n", "region eyes of the key shapes is not in it"),
    ],
)
def test_masks_that_do_not_fit_are_named(take, text, message):
    (take.folder / "char" / "masks.tsv").write_text(text)
    with pytest.raises(errors.InputError, match=message):
        assembled(take)


def test_a_region_that_moves_nothing_needs_no_sculpts(take):
    (take.folder / "char" / "masks.tsv").write_text(
        "region\taxis\tfrom\tto\nmouth\t\t\t\neyes\t\t\t\n"
    )
    for path in (take.folder / "char" / "sculpts" / "eyes").iterdir():
        path.unlink()
    made = assembled(take)
    assert made.names == [f"mouth.{name}" for name in REGIONS["mouth"]]
    assert made.masks[0].min() == 1.0
    (take.folder / "char" / "masks.tsv").write_text(
        "region\taxis\tfrom\tto\nneck\t\t\t\neyes\t\t\t\nmouth\t\t\t\n"
    )
    with pytest.raises(errors.InputError, match=r"masks\.tsv: no region moves a vertex"):
        assembled(take)


def test_a_pivot_that_is_none_is_refused(take):
    for text in ("1 2", "1 2 x", "1 2 nan"):
        with pytest.raises(errors.InputError, match="not three numbers"):
            assembled(take, pivot=text)


def test_tables_of_controls_become_curves_by_the_same_formula(take):
    folder = take.folder / "sliders"
    rng = np.random.default_rng(0)
    names = ["jaw", "smile", "lid"]
    poses = {None: rng.normal(size=3)} | {key: rng.normal(size=3) for key in take.deltas}
    for key, values in poses.items():
        path = (
            folder / "neutral.csv" if key is None else folder / "sculpts" / key[0] / f"{key[1]}.csv"
        )
        path.parent.mkdir(parents=True, exist_ok=True)
        rows = [f"{name},{value}" for name, value in zip(names, values, strict=True)]
        path.write_text("\n".join(["name,value", *rows]) + "\n")
    (folder / "masks.tsv").write_text(
        "vertex\tregion\tweight\njaw\tmouth\t1\nsmile\tmouth\t0.5\nsmile\teyes\t0.5\nlid\teyes\t1\n"
    )
    options = take.rig_options(
        neutral=f"{folder}/neutral.csv",
        masks=f"{folder}/masks.tsv",
        sculpt_folder=f"{folder}/sculpts",
    )
    cut = options.index("--sculpts") + 1
    sculpts = [str(path) for path in sorted((folder / "sculpts").rglob("*.csv"))]
    assemble_rig.main([*options[:cut], *sculpts])
    smooth_weights.main(take.weights_options(head="none"))
    options = {"rig": f"{take.folder}/rig.npz", "weights": f"{take.folder}/weights.parquet"}
    options |= {"controls": f"{folder}/controls.parquet", "csv": f"{folder}/controls.csv"}
    bake_controls.main(words(options))
    curves = series.read(folder / "controls.parquet", "controls").columns
    masks = {"mouth": [1, 0.5, 0], "eyes": [0, 0.5, 1]}
    for index, name in enumerate(names):
        expected = poses[None][index] + sum(
            masks[key[0]][index]
            * take.weights[".".join(key)]
            * (poses[key][index] - poses[None][index])
            for key in take.deltas
        )
        np.testing.assert_allclose(curves[name], expected, atol=1e-5)
    assert (folder / "controls.csv").read_text().splitlines()[0] == "frame,time_s,jaw,smile,lid"
