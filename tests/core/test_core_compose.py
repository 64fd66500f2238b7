import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import compose, head_transform


@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(1, 3))
def test_what_moves_is_the_contract_written_out_as_loops(seed, shapes, regions):
    rng = np.random.default_rng(seed)
    count = 7
    neutral = rng.normal(size=(count, 3))
    sculpts = neutral + rng.normal(size=(shapes, count, 3))
    masks = rng.dirichlet(np.ones(regions), count).T
    region_of = rng.integers(0, regions, shapes)
    weights = rng.normal(size=shapes)
    angle = rng.normal()
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    shift, scale, pivot = rng.normal(size=3), 1 + 0.1 * rng.normal(), rng.normal(size=3)

    expected = np.zeros_like(neutral)
    for v in range(count):
        point = neutral[v].copy()
        for region in range(regions):
            inner = np.zeros(3)
            for i in range(shapes):
                if region_of[i] == region:
                    inner += weights[i] * (sculpts[i, v] - neutral[v])
            point += masks[region, v] * inner
        expected[v] = pivot + scale * turn @ (point - pivot) + shift

    masked = compose.mask_deltas(sculpts - neutral, masks, region_of)
    moved = head_transform.apply(
        compose.compose(neutral, masked, weights), turn, shift, scale, pivot
    )
    np.testing.assert_allclose(moved, expected, rtol=0, atol=1e-12)


def test_a_controls_values_follow_the_same_formula_in_one_dimension():
    neutral = np.array([[0.0], [0.2]])
    poses = np.array([[[1.0], [0.2]], [[0.0], [1.2]]])
    masked = compose.mask_deltas(poses - neutral, np.eye(2), np.array([0, 1]))
    np.testing.assert_allclose(
        compose.compose(neutral, masked, np.array([0.5, -0.5])), [[0.5], [-0.3]]
    )


def test_shapes_that_do_not_fit_are_named():
    with pytest.raises(ValueError, match=r"\(2, 5, 3\).*\(1, 4\)"):
        compose.mask_deltas(np.zeros((2, 5, 3)), np.ones((1, 4)), np.zeros(2, int))
    with pytest.raises(ValueError, match="do not fit"):
        compose.compose(np.zeros((5, 3)), np.zeros((2, 5, 3)), np.zeros(3))
