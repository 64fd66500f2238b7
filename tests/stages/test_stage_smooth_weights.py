from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial.transform
from small_take import FRAMES, RATE, SmallTake

from stages import assemble_rig, smooth_weights
from stages.files import errors, rig, weights


@pytest.fixture
def take(tmp_path):
    made = SmallTake(tmp_path)
    assemble_rig.main(made.rig_options())
    return made


def smoothed(take, **options):
    smooth_weights.main(take.weights_options(**options))
    names = rig.read_any(take.folder / "rig.npz").names
    return names, weights.read(take.folder / "weights.parquet", names)


def test_at_the_films_rate_nothing_changes(take):
    names, read = smoothed(take)
    expected = np.stack([take.weights[name] for name in names], axis=1).astype(np.float32)
    np.testing.assert_array_equal(read.shapes, expected)
    np.testing.assert_array_equal(read.translation, take.shift.astype(np.float32))
    np.testing.assert_allclose(read.rotation, take.turns, atol=1e-7)
    assert read.rate == RATE


def test_another_rate_interpolates_exactly(take):
    names, read = smoothed(take, rate="24000/1001")
    assert read.rate == Fraction(24000, 1001)
    times = read.frame * 1001 / 24000
    assert times[-1] <= (FRAMES - 1) / 30 < times[-1] + 1001 / 24000
    for column, name in enumerate(names):
        expected = np.interp(times, np.arange(FRAMES) / 30, take.weights[name])
        np.testing.assert_allclose(read.shapes[:, column], expected, atol=1e-6)
    rotations = scipy.spatial.transform.Rotation.from_quat(take.turns)
    expected = scipy.spatial.transform.Slerp(np.arange(FRAMES) / 30, rotations)(times)
    apart = scipy.spatial.transform.Rotation.from_quat(read.rotation) * expected.inv()
    assert apart.magnitude().max() < 1e-5


def test_untracked_frames_are_spanned_and_marked(take):
    lost = np.isin(np.arange(FRAMES), [0, 7, 8])
    for name in take.weights:
        take.weights[name] = np.where(lost, np.nan, np.arange(FRAMES, dtype=float))
    take.turns[lost] = np.nan
    take.turns[9:] *= -1
    take.write_weights()
    take.write_head()
    _, read = smoothed(take)
    np.testing.assert_allclose(read.shapes[:, 0], [1, *range(1, FRAMES)], atol=1e-6)
    np.testing.assert_array_equal(read.confidence == 0, lost)
    assert (np.sum(read.rotation[1:] * read.rotation[:-1], axis=1) > 0).all()
    _, slower = smoothed(take, rate="25")
    touched = [frame for frame in slower.frame if 6 < frame * 30 / 25 < 9 or frame == 0]
    np.testing.assert_array_equal(slower.frame[slower.confidence == 0], touched)


def test_head_motion_can_be_left_out(take):
    _, read = smoothed(take, head="none")
    np.testing.assert_array_equal(read.rotation, np.tile([0, 0, 0, 1], (FRAMES, 1)))
    np.testing.assert_array_equal(read.translation, 0)
    np.testing.assert_array_equal(read.scale, 1)


def test_bad_input_is_named(take):
    for rate in ("fast", "0", "1/0"):
        with pytest.raises(errors.InputError, match=r"is no rate such as 30 or 30000/1001"):
            smoothed(take, rate=rate)
    first = next(iter(take.weights))
    take.write_weights(**{first: np.full(FRAMES, np.nan)})
    with pytest.raises(errors.InputError, match=r"key_weights\.parquet: no frame was tracked"):
        smoothed(take)
    del take.weights[first]
    take.write_weights()
    with pytest.raises(errors.InputError, match=rf"column {first}, which the rig needs"):
        smoothed(take)
