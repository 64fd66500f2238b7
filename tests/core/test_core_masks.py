import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import masks


def test_ramp_rises_between_the_heights_in_either_direction():
    heights = np.array([-1.0, 0.0, 0.5, 2.0, 3.0])
    np.testing.assert_allclose(masks.ramp(heights, 0.0, 2.0), [0, 0, 0.25, 1, 1])
    np.testing.assert_allclose(masks.ramp(heights, 2.0, 0.0), [1, 1, 0.75, 0, 0])
    with pytest.raises(ValueError, match="no length"):
        masks.ramp(heights, 1.0, 1.0)


@given(st.integers(0, 2**32 - 1), st.integers(1, 4))
def test_ramps_and_lists_always_make_a_partition_of_unity(seed, count):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(20, 3))
    ramps = [(r, int(rng.integers(3)), *rng.normal(size=2)) for r in range(1, count)]
    values = masks.by_ramps(points, count + 1, 0, ramps, [(count, [3, 7])])
    assert masks.first_fault(values) is None
    np.testing.assert_allclose(values.sum(axis=0), 1.0)
    np.testing.assert_array_equal(values[count], np.isin(np.arange(20), [3, 7]))
    if ramps:
        last = masks.ramp(points[:, ramps[-1][1]], *ramps[-1][2:])
        free = ~np.isin(np.arange(20), [3, 7])
        assert (values[ramps[-1][0]][free] >= last[free] - 1e-12).all()


def test_the_first_vertex_that_breaks_the_partition_is_named():
    values = np.array([[1.0, 0.5, 0.6], [0.0, 0.5, 0.6]])
    assert masks.first_fault(values) == (2, "the weights sum to 1.2 in place of 1")
    values[:, 1] = [-0.5, 1.5]
    assert masks.first_fault(values)[0] == 1
    assert "below zero" in masks.first_fault(values)[1]
    rounded = np.array([[0.33333], [0.66666]])
    assert masks.first_fault(rounded) is None
    assert masks.normalised(rounded).sum() == 1.0
