import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import follower

RATES = (24.0, 30.0, 60.0, 120.0)
LAG = 0.2


def ramp_response(t, lag, damping):
    """Return the analytic answer to a ramp of slope one from rest."""
    pace = 2 * damping / lag
    if damping < 1:
        swing = pace * np.sqrt(1 - damping**2)
        sine = np.sin(swing * t) * (1 - 2 * damping**2) / swing
        ring = np.exp(-damping * pace * t) * (lag * np.cos(swing * t) - sine)
    elif damping == 1:
        ring = np.exp(-pace * t) * (lag + t)
    else:
        root = pace * np.sqrt(damping**2 - 1)
        sine = np.sinh(root * t) * (2 * damping**2 - 1) / root
        ring = np.exp(-damping * pace * t) * (lag * np.cosh(root * t) + sine)
    return np.where(t > 0, t - lag + ring, 0.0)


def step_response(t, lag, damping):
    pace = 2 * damping / lag
    if damping < 1:
        swing = pace * np.sqrt(1 - damping**2)
        share = damping / np.sqrt(1 - damping**2)
        ring = np.exp(-damping * pace * t) * (np.cos(swing * t) + share * np.sin(swing * t))
    else:
        ring = np.exp(-pace * t) * (1 + pace * t)
    return np.where(t > 0, 1 - ring, 0.0)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("damping", [0.3, 0.7, 1.0, 2.0])
def test_a_ramp_is_followed_as_the_equation_says(rate, damping):
    time = np.arange(int(2 * rate)) / rate
    made = follower.follow(time[:, None], rate, LAG, damping)
    np.testing.assert_allclose(made[:, 0], ramp_response(time, LAG, damping), atol=1e-11)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("damping", [0.3, 0.7, 1.0])
def test_a_step_is_followed_as_the_equation_says(rate, damping):
    """A step between two frames is a ramp that begins and one that ends it."""
    time = np.arange(int(2 * rate)) / rate
    curve = np.where(time >= 0.5, 1.0, 0.0)
    first = np.flatnonzero(curve)[0]
    made = follower.follow(curve[:, None], rate, LAG, damping)[:, 0]
    begins = ramp_response(time - time[first - 1], LAG, damping)
    expected = (begins - ramp_response(time - time[first], LAG, damping)) * rate
    np.testing.assert_allclose(made, expected, atol=1e-10)
    middle = time - (time[first - 1] + time[first]) / 2
    late = middle > 0.05
    ideal = step_response(middle, LAG, damping)
    assert np.abs(made - ideal)[late].max() < 0.02 * (24 / rate) ** 2
    if damping < 1:
        over = np.exp(-np.pi * damping / np.sqrt(1 - damping**2))
        assert made.max() - 1 == pytest.approx(over, rel=0.05)
    else:
        assert made.max() <= 1 + 1e-12


def test_the_rate_of_the_frames_does_not_matter():
    rng = np.random.default_rng(1)
    coarse = np.cumsum(rng.standard_normal((40, 3)), axis=0)
    fine = np.stack([np.interp(np.arange(157) / 4, np.arange(40), one) for one in coarse.T], 1)
    slow = follower.follow(coarse, 30.0, LAG, 0.5)
    fast = follower.follow(fine, 120.0, LAG, 0.5)
    np.testing.assert_allclose(fast[::4], slow, atol=1e-11)


@given(st.floats(-1e3, 1e3), st.floats(0.0, 3.0), st.floats(0.1, 5.0))
def test_a_constant_stays_to_the_bit(value, lag, damping):
    values = np.full((50, 2), value)
    np.testing.assert_array_equal(follower.follow(values, 30.0, lag, damping), values)


def test_without_lag_nothing_changes():
    values = np.random.default_rng(0).standard_normal((20, 3))
    np.testing.assert_array_equal(follower.follow(values, 30.0, 0.0, 0.5), values)


def test_gaps_stay_gaps_and_spoil_nothing():
    time = np.arange(90)[:, None] / 30.0
    values = np.hstack([time, 2 * time])
    whole = follower.follow(values, 30.0, LAG, 0.6)
    values[20:30, 0] = np.nan
    made = follower.follow(values, 30.0, LAG, 0.6)
    assert np.isnan(made[20:30, 0]).all()
    known = np.isfinite(values)
    np.testing.assert_allclose(made[known], whole[known], atol=1e-12)


@pytest.mark.parametrize(("lag", "damping"), [(-0.1, 1.0), (0.1, 0.0), (np.nan, 1.0)])
def test_impossible_settings_are_refused(lag, damping):
    with pytest.raises(ValueError, match="lag"):
        follower.follow(np.zeros((3, 1)), 30.0, lag, damping)
