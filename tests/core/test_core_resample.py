from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial.transform
from hypothesis import given
from hypothesis import strategies as st

from stages.core import resample

RATES = st.sampled_from(
    [Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(30), Fraction(60)]
)


@given(RATES, RATES, st.integers(0, 5000), st.integers(1, 60))
def test_linear_motion_is_kept_exactly_at_any_rate(source, target, first, count):
    frames = resample.covered_frames(first, count, source, target)
    times = [Fraction(int(frame)) / target for frame in frames]
    start, end = first / source, (first + count - 1) / source
    assert all(start <= time <= end for time in times)
    step = 1 / target
    assert not times or (times[0] - step < start and times[-1] + step > end)
    below, share = resample.positions(frames, first, count, source, target)
    values = (first + np.arange(count)) / float(source)
    np.testing.assert_allclose(
        resample.linear(values, below, share), [float(time) for time in times], atol=1e-9
    )


@given(RATES, st.integers(0, 1000), st.integers(1, 30), st.integers(0, 2**32 - 1))
def test_equal_rates_change_no_bit(rate, first, count, seed):
    rng = np.random.default_rng(seed)
    values, turns = rng.normal(size=(count, 3)), rng.normal(size=(count, 4))
    frames = resample.covered_frames(first, count, rate, rate)
    np.testing.assert_array_equal(frames, first + np.arange(count))
    place = resample.positions(frames, first, count, rate, rate)
    np.testing.assert_array_equal(resample.linear(values, *place), values)
    np.testing.assert_array_equal(resample.slerp(turns, *place), turns)


def test_slerp_is_scipys():
    rotations = scipy.spatial.transform.Rotation.random(9, random_state=3)
    place = np.linspace(0, 8, 50)
    below = np.minimum(place.astype(int), 7)
    ours = resample.slerp(rotations.as_quat(), below, place - below)
    theirs = scipy.spatial.transform.Slerp(np.arange(9), rotations)(place)
    angle = (scipy.spatial.transform.Rotation.from_quat(ours) * theirs.inv()).magnitude()
    assert angle.max() < 1e-7


def test_gaps_are_spanned_and_ends_are_held():
    observed = np.array([False, True, False, False, True, True, False])
    below, share = resample.neighbours(observed)
    known = np.array([10.0, 40.0, 50.0])
    np.testing.assert_allclose(resample.linear(known, below, share), [10, 10, 20, 30, 40, 50, 50])
    with pytest.raises(ValueError, match="no frame"):
        resample.neighbours(np.zeros(3, bool))


@given(st.integers(0, 2**32 - 1))
def test_signs_are_made_continuous_without_another_rotation(seed):
    rng = np.random.default_rng(seed)
    smooth = np.cumsum(rng.normal(scale=0.1, size=(20, 4)), axis=0) + np.array([0, 0, 0, 5.0])
    flipped = smooth * rng.choice([-1, 1], size=(20, 1))
    cured = resample.continuous(flipped)
    assert (np.sum(cured[1:] * cured[:-1], axis=1) > 0).all()
    np.testing.assert_allclose(np.abs(cured), np.abs(flipped))
