"""The tortoise of the example: one order of vertices, shut beak and lids, a still head, masks."""

import pathlib

import numpy as np
import pytest
import trimesh

from data_example import generate
from data_example.generator import play, tortoise, tortoise_files, tortoise_poses, tortoise_rig
from data_example.generator import tortoise_parts as parts
from stages.files import mesh

FOLDER = pathlib.Path(generate.__file__).parent / "characters" / "tortoise"
LIMIT = 6e5
SHUT = ("speech_m", "emotion_anger", "emotion_sadness", "emotion_serenity", "emotion_trust")


@pytest.fixture(scope="module")
def character():
    return tortoise_rig.build()


@pytest.fixture(scope="module")
def neutral(character):
    return character.pose(tortoise.pose_of())


@pytest.fixture(scope="module")
def posed(character):
    return {name: character.pose(p) for name, p in tortoise_poses.all_poses().items()}


def ring(points, row):
    """Return one ring of the skin, (COLUMNS, 3)."""
    return points[row * tortoise.COLUMNS : (row + 1) * tortoise.COLUMNS]


def beak_gap(points):
    """Return how far the edges of the beak stand apart, from corner to corner."""
    edge, half = ring(points, tortoise.EDGE), tortoise.COLUMNS // 2
    return np.linalg.norm(edge[1:half] - edge[:half:-1], axis=1)


def lid_gap(character, points, side):
    """Return how far the lids' inner edges stand apart, from corner to corner."""
    lids = points[character.slices[f"lid_{side}"]].reshape(parts.LID_ROWS, parts.LIDS, 3)
    half = parts.LIDS // 2
    return np.linalg.norm(lids[0, 1:half] - lids[0, :half:-1], axis=1)


def shift(character, neutral, points, piece):
    """Return the mean displacement of a piece, (3,)."""
    here = character.slices[piece]
    return (points[here] - neutral[here]).mean(axis=0)


def test_every_extreme_but_the_neutral_ones_has_a_pose(posed):
    at_rest = {"emotion_neutral", "speech_rest", "blink_open"}
    assert set(posed) == set(play.NAMES) - at_rest
    assert {path.stem for path in (FOLDER / "poses").iterdir()} == set(posed)


def test_files_hold_what_is_modelled_in_one_topology(character, neutral, posed):
    first = mesh.read(FOLDER / "neutral.ply")
    assert 900 <= len(first.vertices) <= 1300
    np.testing.assert_allclose(first.vertices, neutral, atol=1e-5)
    np.testing.assert_array_equal(first.corners.reshape(-1, 4), character.faces)
    np.testing.assert_allclose(first.colours, character.colours, atol=1 / 255)
    for name, points in posed.items():
        path = FOLDER / "poses" / f"{name}.ply"
        read = mesh.read(path)
        np.testing.assert_array_equal(read.corners, first.corners)
        np.testing.assert_array_equal(read.sizes, first.sizes)
        second = trimesh.load(path, process=False, maintain_order=True)
        np.testing.assert_allclose(second.vertices, points, atol=1e-5)


def test_poses_stay_small():
    assert sum(path.stat().st_size for path in (FOLDER / "poses").iterdir()) < LIMIT


def test_all_pieces_face_outwards(character, neutral):
    faces = np.concatenate([character.faces[:, [0, 1, 2]], character.faces[:, [0, 2, 3]]])
    a, b, c = neutral[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    assert (np.linalg.norm(normals, axis=1) > 1e-6).all()
    for name, here in character.slices.items():
        own = (faces[:, 0] >= here.start) & (faces[:, 0] < here.stop)
        if name.startswith(("nose", "glint")):
            assert normals[own, 2].sum() > 0, name
        else:
            away = (a + b + c)[own] / 3 - neutral[here].mean(axis=0)
            assert np.sum(normals[own] * away) > 1, name


def test_the_neutral_is_the_same_on_both_sides(character, neutral):
    for name in ("ball", "lid", "ridge"):
        right, left = (neutral[character.slices[f"{name}_{side}"]] for side in ("r", "l"))
        for axis in (1, 2):
            ordered = [np.sort(points[:, axis]) for points in (right, left)]
            np.testing.assert_allclose(*ordered, atol=1e-9)


@pytest.mark.parametrize("name", SHUT)
def test_the_beak_is_shut(posed, name):
    assert beak_gap(posed[name]).max() < 1e-9
    # and the upper beak hangs before the lower one, so that nothing of the mouth is seen
    rim, half = ring(posed[name], tortoise.RIM), tortoise.COLUMNS // 2
    low, high = rim[1:half], rim[:half:-1]
    assert (high[:, 2] > low[:, 2]).all()
    assert (high[:, 1] < ring(posed[name], tortoise.EDGE)[1:half, 1]).all()


def test_speech_opens_the_beak_as_its_sounds_do(neutral, posed):
    width = {n: np.ptp(ring(p, tortoise.EDGE)[:, 0]) for n, p in posed.items()}
    gap = {n: beak_gap(p).max() for n, p in posed.items()}
    rest = np.ptp(ring(neutral, tortoise.EDGE)[:, 0])
    assert gap["speech_aa"] == max(gap[n] for n in gap if n.startswith("speech"))
    assert gap["speech_aa"] > 4
    assert gap["speech_aa"] > gap["speech_oh"] > gap["speech_ee"] > 0.5
    assert width["speech_oo"] < 0.6 * rest
    assert width["speech_ee"] > 1.05 * rest


def test_blinks_shut_the_lids_before_the_balls(character, neutral, posed):
    for side in ("r", "l"):
        assert lid_gap(character, neutral, side).max() > 2
        assert lid_gap(character, posed["blink_closed"], side).max() < 1e-9
        half = lid_gap(character, posed["blink_half"], side).max()
        assert 0.3 < half / lid_gap(character, neutral, side).max() < 0.7
        lids = posed["blink_closed"][character.slices[f"lid_{side}"]]
        ball = posed["blink_closed"][character.slices[f"ball_{side}"]]
        centre = parts.EYE * [1 if side == "l" else -1, 1, 1]
        nearest = np.linalg.norm(lids[: 5 * parts.LIDS] - centre, axis=1).min()
        assert nearest > np.linalg.norm(ball - centre, axis=1).max()


def test_layers_move_what_is_theirs(character, neutral, posed):
    for name, points in posed.items():
        moved = {
            piece
            for piece, here in character.slices.items()
            if (points[here] != neutral[here]).any()
        }
        if name.startswith("blink"):
            assert moved == {"lid_r", "lid_l"}
        elif name.startswith("speech"):
            assert moved <= {"skin", "tongue", "nose_r", "nose_l"}
        else:
            assert {"skin", "shell", "ridge_r", "ridge_l", "lid_r", "lid_l"} <= moved


def test_moods_show_in_the_neck_while_the_head_stays(character, neutral, posed):
    crown = slice((tortoise.MOUTH + 4) * tortoise.COLUMNS + 15, None)
    for points in posed.values():
        still = points[crown][:7] - neutral[crown][:7]
        assert np.abs(still).max() < 0.05
    down = {n: -shift(character, neutral, p, "shell")[1] for n, p in posed.items()}
    assert down["emotion_amazement"] > down["emotion_joy"] > 2
    assert down["emotion_grief"] < down["emotion_sadness"] < -2
    assert down["emotion_anger"] < 0
    inner = slice(None, None, parts.RIDGE)
    for name, sign in (("emotion_anger", -1), ("emotion_surprise", 1), ("emotion_sadness", 1)):
        for side in ("r", "l"):
            here = character.slices[f"ridge_{side}"]
            assert sign * (posed[name][here] - neutral[here])[inner, 1].mean() > 0.3


def test_masks_are_painted_as_a_smooth_partition_of_unity(character):
    painted = mesh.read(FOLDER / "masks.ply")
    first = mesh.read(FOLDER / "neutral.ply")
    np.testing.assert_array_equal(painted.vertices, first.vertices)
    np.testing.assert_allclose(painted.colours.sum(axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(painted.colours.T, character.masks, atol=1 / 255)
    edges = np.concatenate([character.faces[:, [i, (i + 1) % 4]] for i in range(4)])
    steps = np.abs(painted.colours[edges[:, 0]] - painted.colours[edges[:, 1]])
    assert steps.max() < 0.8
    assert (painted.colours.max(axis=0) == 1).all()


def test_painting_rounds_to_bytes_that_sum_to_255():
    rng = np.random.default_rng(3)
    masks = rng.dirichlet(np.full(3, 0.4), 500).T
    whole = tortoise_files.painted(masks) * 255
    np.testing.assert_allclose(whole, np.round(whole), atol=1e-9)
    np.testing.assert_allclose(whole.sum(axis=1), 255)
    assert np.abs(whole / 255 - masks.T).max() < 1 / 255
