import logging

import numpy as np
import pytest
from small_take import write_obj

from stages import assemble_blendshapes
from stages.core import local_shapes
from stages.files import errors, rig

FACES = np.array([[0, 1, 2], [0, 2, 3]])
NEUTRAL = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])


def assemble(folder, shapes, **changed):
    write_obj(folder / "neutral.obj", NEUTRAL, FACES)
    paths = []
    for name, vertices in shapes.items():
        paths.append(folder / f"{name}.obj")
        write_obj(paths[-1], vertices, FACES[: len(vertices) - 2])
    settings = {
        "neutral": folder / "neutral.obj",
        "shape-folder": folder,
        "unit": "cm",
        "up-axis": "y",
        "pivot": "0 -1 2",
        "face-unit": 6.5,
        "rig": folder / "rig.npz",
    } | {name.replace("_", "-"): value for name, value in changed.items()}
    argv = ["--shapes", *map(str, paths)]
    for name, value in settings.items():
        argv += [f"--{name}", str(value)]
    assemble_blendshapes.main(argv)
    return rig.read(folder / "rig.npz", "mesh")


def test_every_shape_is_kept_and_only_where_it_moves(tmp_path):
    moved = NEUTRAL + np.array([[0, 0, 0], [0, 0, 0.5], [0, 0, 0], [0, -0.25, 0]])
    made = assemble(tmp_path, {"jawOpen": moved, "eyeBlinkLeft": NEUTRAL + np.array([0, 0, 1])})
    assert made.names == ["face.jawOpen", "face.eyeBlinkLeft"]
    np.testing.assert_allclose(
        local_shapes.dense(made.deltas), [moved - NEUTRAL, np.tile([0, 0, 1.0], (4, 1))]
    )
    assert list(made.deltas.vertices) == [1, 3, 0, 1, 2, 3]
    np.testing.assert_array_equal(made.masks, np.ones((1, 4)))


def test_a_shape_that_moves_nothing_is_kept_and_said(tmp_path, caplog):
    with caplog.at_level(logging.WARNING):
        made = assemble(tmp_path, {"still": NEUTRAL, "up": NEUTRAL + 1})
    assert made.names == ["face.still", "face.up"]
    assert "still.obj: is the neutral itself" in caplog.text


def test_two_files_of_one_shape_are_refused(tmp_path):
    (tmp_path / "other").mkdir()
    folders = tmp_path, tmp_path / "other"
    for folder in folders:
        write_obj(folder / "jawOpen.obj", NEUTRAL + 1, FACES)
    write_obj(tmp_path / "neutral.obj", NEUTRAL, FACES)
    argv = ["--shapes", *(str(folder / "jawOpen.obj") for folder in folders)]
    argv += ["--neutral", str(tmp_path / "neutral.obj"), "--shape-folder", str(tmp_path)]
    argv += ["--unit", "cm", "--up-axis", "y", "--pivot", "0 0 0", "--face-unit", "1"]
    with pytest.raises(errors.InputError, match="'jawOpen' stands in two files"):
        assemble_blendshapes.main([*argv, "--rig", str(tmp_path / "rig.npz")])


@pytest.mark.parametrize(
    ("shapes", "changed", "message"),
    [
        ({"short": NEUTRAL[:3]}, {}, r"short\.obj: has 3 vertices, the neutral has 4"),
        ({}, {}, "holds no shape: export each"),
        ({"jaw.open": NEUTRAL}, {}, "'jaw.open' is no name of a shape"),
        ({"jawOpen": NEUTRAL}, {"pivot": "0 1"}, "'0 1' is not three numbers"),
    ],
)
def test_faults_are_named(tmp_path, shapes, changed, message):
    with pytest.raises(errors.InputError, match=message):
        assemble(tmp_path, shapes, **changed)
    assert not (tmp_path / "rig.npz").exists()
