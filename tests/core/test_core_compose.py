import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import compose, head_transform, local_shapes


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

    masked = local_shapes.masked(local_shapes.gather(sculpts - neutral), masks, region_of)
    moved = head_transform.apply(
        compose.compose(neutral, compose.blocks(masked), weights[None])[0],
        turn,
        shift,
        scale,
        pivot,
    )
    np.testing.assert_allclose(moved, expected, rtol=0, atol=1e-12)


def test_a_controls_values_follow_the_same_formula_in_one_dimension():
    neutral = np.array([[0.0], [0.2]])
    poses = np.array([[[1.0], [0.2]], [[0.0], [1.2]]])
    masked = local_shapes.masked(local_shapes.gather(poses - neutral), np.eye(2), np.array([0, 1]))
    np.testing.assert_allclose(
        compose.compose(neutral, compose.blocks(masked), np.array([[0.5, -0.5]])),
        [[[0.5], [-0.3]]],
    )


def test_shapes_that_do_not_fit_are_named():
    shapes = local_shapes.gather(np.ones((2, 5, 3)))
    with pytest.raises(ValueError, match=r"\(1, 4\).*2 shapes of 5 vertices"):
        local_shapes.masked(shapes, np.ones((1, 4)), np.zeros(2, int))
    with pytest.raises(ValueError, match=r"\(5, 3\).*\(1, 1\)"):
        compose.compose(np.zeros((5, 3)), compose.blocks(shapes), np.zeros((1, 1)))
    with pytest.raises(ValueError, match=r"\(4, 3\)"):
        compose.compose(np.zeros((4, 3)), compose.blocks(shapes), np.zeros((1, 2)))
    with pytest.raises(ValueError, match="one form"):
        local_shapes.gather([np.zeros((4, 3)), np.zeros((5, 3))])


@given(st.integers(0, 2**32 - 1), st.integers(1, 5), st.integers(1, 700))
def test_local_shapes_compose_as_dense_ones_do(seed, count, vertices):
    rng = np.random.default_rng(seed)
    deltas = rng.normal(size=(count, vertices, 3)) * (rng.random((count, vertices, 1)) < 0.2)
    shapes = local_shapes.gather(deltas)
    np.testing.assert_array_equal(local_shapes.dense(shapes), deltas)
    some = rng.integers(0, vertices, 4)
    np.testing.assert_array_equal(local_shapes.at(shapes, some), deltas[:, some])
    neutral, weights = rng.normal(size=(vertices, 3)), rng.normal(size=(3, count))
    np.testing.assert_allclose(
        compose.compose(neutral, compose.blocks(shapes), weights),
        neutral + np.einsum("tk,kvd->tvd", weights, deltas),
        atol=1e-12,
    )
