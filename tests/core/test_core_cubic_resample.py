import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from stages.core import cubic_resample

SEEDS = st.integers(0, 2**32 - 1)


@settings(deadline=None, max_examples=40)
@given(SEEDS, st.integers(4, 40))
def test_cubics_are_reproduced_inside(seed, count):
    rng = np.random.default_rng(seed)
    polynomial = np.polynomial.Polynomial(rng.normal(size=4), domain=[0, count], window=[-1, 1])
    # to thousandths: a place closer to a sample than rounding is that sample
    wanted = np.round(rng.uniform(1, count - 2, 30), 3)
    found = cubic_resample.cubic(polynomial(np.arange(count)), cubic_resample.places(wanted, count))
    np.testing.assert_allclose(found, polynomial(wanted), atol=1e-10)


@settings(deadline=None, max_examples=40)
@given(SEEDS, st.integers(1, 30), st.integers(-40, 40))
def test_whole_shifts_change_no_bit(seed, count, shift):
    values = np.random.default_rng(seed).normal(size=count).astype(np.float32)
    wanted = np.arange(count) + shift + 1e-9
    found = cubic_resample.cubic(values, cubic_resample.places(wanted, count))
    inside = (np.round(wanted) >= 0) & (np.round(wanted) < count)
    np.testing.assert_array_equal(np.isfinite(found), inside)
    np.testing.assert_array_equal(found[inside], values[np.round(wanted).astype(int)[inside]])


@settings(deadline=None, max_examples=40)
@given(SEEDS, st.floats(-3, 3))
def test_gaps_stay_and_grow_by_less_than_one_sample(seed, shift):
    rng = np.random.default_rng(seed)
    values = rng.normal(size=60)
    values[rng.random(60) < 0.2] = np.nan
    assume(1e-4 < abs(shift % 1) < 1 - 1e-4)  # whole shifts: above
    wanted = np.arange(60) + shift
    at = cubic_resample.places(wanted, 60)
    found = cubic_resample.cubic(values, at)
    missing = np.flatnonzero(np.isnan(values))
    for place, value in zip(wanted, found, strict=True):
        distance = np.abs(missing - place).min() if len(missing) else np.inf
        assert np.isnan(value) == (place < 0 or place > 59 or distance < 1)


def test_detail_is_kept_where_a_line_loses_it():
    frames = np.arange(400)
    wave = np.sin(2 * np.pi * 20 / 120 * frames)
    at = cubic_resample.places(frames[2:-2] + 0.5, 400)
    true = np.sin(2 * np.pi * 20 / 120 * (frames[2:-2] + 0.5))
    cubic = np.std(cubic_resample.cubic(wave, at)) / np.std(true)
    line = np.std((wave[2:-2] + wave[3:-1]) / 2) / np.std(true)
    assert cubic > 0.97
    assert line < 0.87


def test_neighbours_give_the_worst_and_the_least():
    values = np.array([0.0, 2.0, 1.0, 0.0])
    at = cubic_resample.places(np.array([-1.0, 0.0, 0.5, 1.0, 2.5, 3.0, 3.5]), 4)
    np.testing.assert_array_equal(cubic_resample.largest(values, at), [0, 0, 2, 2, 1, 0, 0])
    np.testing.assert_array_equal(cubic_resample.smallest(values, at), [0, 0, 0, 2, 0, 0, 0])
