"""The clay head's extremes: tables of shapes that mean what the actress's mean, and its masks."""

import csv
import pathlib

import numpy as np
import pytest

from data_example import generate
from data_example.generator import clay, clay_poses, clay_rig, clay_shapes, play

FOLDER = pathlib.Path(generate.__file__).parent / "characters" / "clay"
AT_REST = {"emotion_neutral", "speech_rest", "blink_open"}


@pytest.fixture(scope="module")
def rig():
    return clay_rig.build()


@pytest.fixture(scope="module")
def tables():
    result = {}
    for path in (FOLDER / "poses").iterdir():
        with path.open(encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        result[path.stem] = {row["name"]: float(row["value"]) for row in rows}
    return result


def vector(pose):
    return np.array([pose.get(name, 0.0) for name in clay_shapes.NAMES])


def lip_gap(points):
    ring = points[clay.INNER * clay.RINGS : (clay.INNER + 1) * clay.RINGS]
    half = clay.RINGS // 2
    return np.linalg.norm(ring[1:half] - ring[:half:-1], axis=1).max()


def posed(rig, pose):
    return rig.neutral + sum(weight * rig.deltas[name] for name, weight in pose.items())


def test_files_hold_every_extreme_in_hundredths(tables):
    assert set(tables) == set(play.NAMES) - AT_REST
    assert tables == clay_poses.all_poses()
    for pose in tables.values():
        assert set(pose) <= set(clay_shapes.NAMES)
        values = np.array(list(pose.values()))
        assert ((values > 0) & (values <= 1)).all()
        np.testing.assert_allclose(values * 100, np.round(values * 100), atol=1e-9)


def test_each_pose_means_what_the_actress_means_but_is_no_copy(tables):
    acted = dict(zip(play.NAMES, clay_shapes.weights(play.poses()), strict=True))
    names = [name for name in tables if not name.startswith("blink")]
    moves = np.stack([vector(tables[name]) for name in names])
    hers = np.stack([acted[name] for name in names])
    units = [table / np.linalg.norm(table, axis=1)[:, None] for table in (moves, hers)]
    likeness = units[0] @ units[1].T
    assert (np.diag(likeness) > 0.85).all()
    assert (likeness.argmax(axis=1) == np.arange(len(names))).all()
    assert np.abs(moves - hers).max() > 0.2


def test_m_keeps_the_lips_together_and_closed_shuts_the_lids(rig, tables):
    assert lip_gap(posed(rig, tables["speech_m"])) < 0.02
    assert lip_gap(posed(rig, tables["speech_aa"])) > 2
    assert tables["blink_closed"] == {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}


def test_masks_are_a_soft_partition_of_unity(rig):
    masks = dict.fromkeys(("upper", "mouth", "eyes"))
    masks = {name: np.zeros(len(rig.neutral)) for name in masks}
    with (FOLDER / "masks.tsv").open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream, delimiter="\t"):
            masks[row["region"]][int(row["vertex"])] = float(row["weight"])
    np.testing.assert_allclose(sum(masks.values()), 1, atol=1e-9)
    soft = (masks["mouth"] > 0.05) & (masks["mouth"] < 0.95)
    assert soft.sum() > 30
    assert (masks["eyes"][rig.slices["ball_l"]] == 1).all()
    assert (masks["upper"][rig.slices["brow_r"]] > 0.9).all()
    assert (masks["mouth"][rig.slices["lower"]] == 1).all()
    for shape, name in (("jawOpen", "mouth"), ("eyeBlinkLeft", "eyes"), ("browDownLeft", "upper")):
        size = np.linalg.norm(rig.deltas[shape], axis=1)
        assert (size * masks[name]).sum() > 0.6 * size.sum(), shape
