import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from stages.core import morph_sides

WEIGHTS = hnp.arrays(
    float, st.tuples(st.integers(1, 6), st.integers(1, 5)), elements=st.floats(-3, 3)
)


@given(WEIGHTS, st.floats(0, 1))
def test_sides_give_the_same_sum_at_frames_and_between_and_stay_in_range(weights, share):
    sides = morph_sides.split(weights)
    assert sides.weights.min() >= 0 and sides.weights.max() <= 1
    offsets = np.random.default_rng(0).normal(size=(weights.shape[1], 7))
    split = sides.gain[:, None] * offsets[sides.shape]
    np.testing.assert_allclose(sides.weights @ split, weights @ offsets, atol=1e-9)
    between = (1 - share) * weights[0] + share * weights[-1]
    found = (1 - share) * sides.weights[0] + share * sides.weights[-1]
    np.testing.assert_allclose(found @ split, between @ offsets, atol=1e-9)


def test_weights_in_range_stay_as_they_are():
    weights = np.random.default_rng(1).random((9, 4))
    sides = morph_sides.split(weights)
    np.testing.assert_array_equal(sides.weights, weights)
    np.testing.assert_array_equal(sides.gain, np.ones(4))


def test_no_frame_is_refused():
    with pytest.raises(ValueError, match="at least one frame"):
        morph_sides.split(np.zeros((0, 3)))
