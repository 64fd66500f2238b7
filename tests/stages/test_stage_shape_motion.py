from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial.transform

from stages import shape_motion
from stages.core import follower, local_shapes
from stages.files import errors, rig, series

RATE = Fraction(60)
FRAMES = 180
TIME = np.arange(FRAMES) / float(RATE)
LAYERED = ["upper.emotion_joy", "mouth.emotion_joy", "mouth.speech_m", "eyes.blink_closed"]
PLAIN = ["face.browInnerUp", "face.jawOpen", "face.eyeBlink_L", "face.cheekPuff"]
STEP = np.where(TIME < 1, 0.2, 0.8)
CLOSED = (np.abs(TIME - 2) < 0.06).astype(float)
BLINK = (np.abs(TIME - 1.1) < 0.05).astype(float)


def made_rig(folder, names):
    masks = sorted({name.partition(".")[0] for name in names})
    index = np.array([masks.index(name.partition(".")[0]) for name in names])
    blank = np.zeros((0, 3))
    made = rig.Rig(
        names, masks, [], np.zeros((4, 3)), local_shapes.gather(np.ones((len(names), 4, 3))),
        np.full((len(masks), 4), 1 / len(masks)), index, np.array([4]), np.arange(4), blank,
        np.zeros(3), "m", "y", 1.0,
    )  # fmt: skip
    rig.write(folder / "rig.npz", made)


def shaped(folder, names=LAYERED, kind="directed", curves=None, **options):
    """Run the stage and return solution, shaped solution, head and shaped head."""
    made_rig(folder, names)
    curves = curves or [STEP, STEP * (1 - CLOSED), CLOSED, BLINK]
    columns = dict(zip(names, curves, strict=True)) | {"confidence": np.full(FRAMES, 0.9)}
    frames = np.arange(FRAMES)
    meta = {"start_s": 3.5}
    series.write(folder / "solution.parquet", kind, frames, TIME, columns, RATE, meta)
    turns = np.column_stack([0.3 * np.sin(5 * TIME), 0.9 * np.sin(4 * TIME), 0.2 * TIME])
    quaternions = scipy.spatial.transform.Rotation.from_rotvec(turns).as_quat()
    motion = dict(zip([f"rotation.{axis}" for axis in "xyzw"], quaternions.T, strict=True))
    motion |= {f"translation.{axis}": np.sin(3 * TIME) for axis in "xyz"}
    motion |= {"scale": np.ones(FRAMES), "confidence": np.ones(FRAMES), "eye_left.x": 0 * TIME}
    series.write(folder / "head.parquet", "head_motion", frames, TIME, motion, RATE)
    words = {
        "solution": folder / "solution.parquet",
        "head-motion": folder / "head.parquet",
        "rig": folder / "rig.npz",
        "shaped": folder / "shaped.parquet",
        "shaped-head": folder / "shaped_head.parquet",
    } | {name.replace("_", "-"): value for name, value in options.items()}
    shape_motion.main([f"--{name}={value}" for name, value in words.items()])
    read = [series.read(folder / f"{name}.parquet", kind) for name in ("solution", "shaped")]
    heads = ("head", "shaped_head")
    return [*read, *(series.read(folder / f"{name}.parquet", "head_motion") for name in heads)]


def turns_of(motion):
    quaternions = np.stack([motion.columns[f"rotation.{axis}"] for axis in "xyzw"], axis=1)
    return scipy.spatial.transform.Rotation.from_quat(quaternions).as_rotvec()


def test_by_default_nothing_changes(tmp_path):
    solution, made, head, made_head = shaped(tmp_path)
    for before, after in ((solution, made), (head, made_head)):
        assert list(after.columns) == list(before.columns)
        assert after.rate == before.rate
        for name, values in before.columns.items():
            np.testing.assert_array_equal(after.columns[name], values)
    assert made.meta["start_s"] == 3.5
    assert [source["name"] for source in made.meta["sources"]] == ["solution.parquet", "rig.npz"]


def test_emotion_comes_after_and_speech_does_not(tmp_path):
    solution, made, *_ = shaped(tmp_path, follow_s=0.2, damping=0.5)
    for name in ("mouth.speech_m", "eyes.blink_closed", "confidence"):
        np.testing.assert_array_equal(made.columns[name], solution.columns[name])
    expected = follower.follow(solution.columns["upper.emotion_joy"][:, None], 60.0, 0.2, 0.5)
    np.testing.assert_allclose(made.columns["upper.emotion_joy"], expected[:, 0], atol=1e-6)
    assert made.columns["upper.emotion_joy"].max() > 0.88
    mouth = made.columns["mouth.emotion_joy"]
    assert np.abs(mouth[CLOSED == 1]).max() == 0.0
    assert mouth.max() > 0.88


def test_a_rig_keeps_what_moves_lips_and_lids(tmp_path):
    options = {"names": PLAIN, "kind": "predicted", "curves": [STEP] * 4}
    _, made, *_ = shaped(tmp_path, follow_s=0.2, damping=0.5, **options)
    for name in ("face.jawOpen", "face.eyeBlink_L"):
        np.testing.assert_array_equal(made.columns[name], STEP.astype(np.float32))
    assert made.columns["face.browInnerUp"].max() > 0.88
    table = tmp_path / "channels.tsv"
    table.write_text("shape\tkeep\ncheekPuff\tclosure\n")
    _, made, *_ = shaped(tmp_path, follow_s=0.2, damping=0.5, channels=table, **options)
    np.testing.assert_array_equal(made.columns["face.cheekPuff"], STEP.astype(np.float32))
    _, made, *_ = shaped(tmp_path, follow_s=0.2, damping=0.5, followed="all", **options)
    assert made.columns["face.jawOpen"].max() > 0.88


def test_gaps_stay_gaps(tmp_path):
    hole = np.where((TIME > 0.5) & (TIME < 0.7), np.nan, STEP)
    _, made, *_ = shaped(tmp_path, curves=[hole, hole, 0 * hole, 0 * hole], follow_s=0.1)
    for name in LAYERED:
        np.testing.assert_array_equal(np.isnan(made.columns[name]), np.isnan(hole))


def test_the_head_is_scaled_limited_and_turned(tmp_path):
    *_, head, made = shaped(tmp_path, head_gain="0.5 2 0")
    expected = turns_of(head) * [0.5, 2, 0]
    np.testing.assert_allclose(turns_of(made), expected, atol=1e-5)
    for axis in "xyz":
        name = f"translation.{axis}"
        np.testing.assert_array_equal(made.columns[name], head.columns[name])
    *_, made = shaped(tmp_path, head_limit="20")
    angle = np.degrees(np.linalg.norm(turns_of(made), axis=1))
    assert 15 < angle.max() <= 20
    *_, made = shaped(tmp_path, head_axes="y -x z")
    np.testing.assert_allclose(turns_of(made), turns_of(head)[:, [1, 0, 2]] * [1, -1, 1], atol=1e-5)


def test_the_head_follows(tmp_path):
    *_, head, made = shaped(tmp_path, follow_s=0.1, damping=1)
    expected = follower.follow(turns_of(head), 60.0, 0.1, 1.0)
    np.testing.assert_allclose(turns_of(made), expected, atol=1e-5)
    shift = follower.follow(head.columns["translation.x"][:, None], 60.0, 0.1, 1.0)
    np.testing.assert_allclose(made.columns["translation.x"], shift[:, 0], atol=1e-5)
    np.testing.assert_array_equal(made.columns["eye_left.x"], head.columns["eye_left.x"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"head_gain": "1 1"}, r"--head-gain: '1 1' is not 3 numbers"),
        ({"head_gain": "1 1 wide"}, "--head-gain"),
        ({"head_limit": "0"}, "--head-limit: '0' is not a number from 0.1 to 180"),
        ({"head_axes": "x x y"}, "--head-axes: 'x x y' is not x, y and z in some order"),
        ({"follow_s": "-1"}, "--follow-s"),
        ({"damping": "0"}, "--damping: '0' is not a number from 0.05 to 10"),
        ({"damping": "nan"}, "--damping"),
    ],
)
def test_impossible_settings_are_refused(tmp_path, options, message):
    with pytest.raises(errors.InputError, match=message):
        shaped(tmp_path, **options)
