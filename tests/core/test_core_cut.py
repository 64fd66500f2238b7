from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import cut

RATES = [Fraction(24000, 1001), Fraction(24), Fraction(30000, 1001), Fraction(30), Fraction(120)]


@given(
    st.sampled_from(RATES),
    st.sampled_from(RATES),
    st.integers(0, 200),
    st.integers(0, 200),
    st.integers(0, 12),
)
def test_a_frame_is_wanted_if_its_time_lies_within(rate, cut_rate, first, length, handles):
    frames = np.arange(2000)
    start, end = (first - handles) / cut_rate, (first + length + handles) / cut_rate
    expected = [start <= Fraction(int(frame)) / rate <= end for frame in frames]
    if any(expected):
        kept = cut.delivered(frames, rate, first, first + length, handles, cut_rate)
        assert kept.tolist() == expected
    else:
        with pytest.raises(ValueError, match="outside"):
            cut.delivered(frames, rate, first, first + length, handles, cut_rate)


def test_open_ends_are_the_takes_own():
    frames = np.arange(10, 20)
    kept = cut.delivered(frames, Fraction(25), None, 14, 0, Fraction(25))
    assert frames[kept].tolist() == [10, 11, 12, 13, 14]
    assert cut.delivered(frames, Fraction(25), None, None, 5, Fraction(25)).all()


@pytest.mark.parametrize(
    ("first", "last", "message"), [(9, 3, "3 comes before the first 9"), (90, 99, "outside")]
)
def test_what_cannot_be_cut_is_refused(first, last, message):
    with pytest.raises(ValueError, match=message):
        cut.delivered(np.arange(20), Fraction(25), first, last, 0, Fraction(25))
