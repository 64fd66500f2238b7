from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import clock

RATES = [Fraction(24000, 1001), Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(30)]
RATES += [Fraction(50), Fraction(60000, 1001), Fraction(60), Fraction(120)]


@given(st.sampled_from(RATES), st.integers(1, 100_000))
def test_count_of_frames_survives_their_times(rate, count):
    last = float((count - 1) / rate)
    assert clock.frame_count(last, rate) == count


@given(st.sampled_from(RATES), st.integers(2, 300), st.floats(-5, 5), st.floats(-5, 5))
def test_a_straight_line_is_resampled_to_itself(rate, count, slope, start):
    time_s = clock.frame_times(count, rate)
    wanted = np.linspace(0, time_s[-1], 71)
    found = clock.resample((start + slope * time_s)[:, None], time_s, wanted)
    np.testing.assert_allclose(found[:, 0], start + slope * wanted, atol=1e-9)


def test_a_gap_spreads_only_to_times_beside_it():
    values = np.array([[0.0], [np.nan], [2.0], [3.0]])
    found = clock.resample(values, np.arange(4.0), np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 9.0]))
    np.testing.assert_array_equal(np.isnan(found[:, 0]), [0, 1, 1, 1, 0, 0, 0])
    assert found[-1, 0] == 3.0


def test_times_that_go_back_are_refused():
    with pytest.raises(ValueError, match="ascending"):
        clock.resample(np.zeros((3, 1)), np.array([0.0, 2.0, 1.0]), np.zeros(1))
