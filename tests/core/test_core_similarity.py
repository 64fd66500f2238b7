import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import similarity

SEEDS = st.integers(0, 2**31)


def drawn(seed, count=9):
    rng = np.random.default_rng(seed)
    return rng, rng.normal(0, 30, (count, 2))


def some_similarity(rng):
    return similarity.about(
        rng.normal(0, 50, 2), rng.uniform(-np.pi, np.pi), rng.uniform(0.2, 5), rng.normal(0, 9, 2)
    )


@given(SEEDS)
def test_a_similarity_is_recovered(seed):
    rng, points = drawn(seed)
    matrix = some_similarity(rng)
    found = similarity.fit_similarity(points, similarity.apply(matrix, points))
    assert found == pytest.approx(matrix, abs=1e-8)


@given(SEEDS)
def test_an_affine_map_is_recovered(seed):
    rng, points = drawn(seed)
    matrix = rng.normal(size=(2, 3))
    found = similarity.fit_affine(points, similarity.apply(matrix, points))
    assert found == pytest.approx(matrix, abs=1e-7)


@given(SEEDS)
def test_inverse_and_composition(seed):
    rng, points = drawn(seed)
    first, second = some_similarity(rng), some_similarity(rng)
    both = similarity.compose(second, first)
    expected = similarity.apply(second, similarity.apply(first, points))
    assert similarity.apply(both, points) == pytest.approx(expected)
    undone = similarity.apply(similarity.invert(both), expected)
    assert undone == pytest.approx(points, abs=1e-8)


@given(SEEDS)
def test_a_similarity_is_never_a_reflection(seed):
    _, points = drawn(seed)
    found = similarity.fit_similarity(points, points * [-1, 1])
    assert np.linalg.det(found[:, :2]) >= 0


@given(SEEDS)
def test_noise_moves_the_least_squares_fit_to_a_stationary_point(seed):
    rng, points = drawn(seed)
    target = similarity.apply(some_similarity(rng), points) + rng.normal(size=points.shape)
    found = similarity.fit_similarity(points, target)

    def loss(matrix):
        return ((similarity.apply(matrix, points) - target) ** 2).sum()

    for _ in range(5):
        small = similarity.about(
            target.mean(axis=0),
            1e-3 * rng.normal(),
            1 + 1e-3 * rng.normal(),
            rng.normal(0, 1e-2, 2),
        )
        assert loss(similarity.compose(small, found)) >= loss(found)


@given(SEEDS)
def test_the_mean_shape_forgets_similarities(seed):
    rng, shape = drawn(seed)
    copies = np.array([similarity.apply(some_similarity(rng), shape) for _ in range(5)])
    mean = similarity.mean_shape(copies, 10.0)
    assert np.sqrt((mean**2).sum(axis=1).mean()) == pytest.approx(10.0)
    for copy in copies:
        placed = similarity.apply(similarity.fit_similarity(mean, copy), mean)
        assert placed == pytest.approx(copy, abs=1e-6 * np.abs(copy).max())


def test_points_in_one_place_and_other_counts_are_refused():
    with pytest.raises(ValueError, match="in one place"):
        similarity.fit_similarity(np.ones((4, 2)), np.ones((4, 2)))
    with pytest.raises(ValueError, match=r"\(3, 2\)"):
        similarity.fit_affine(np.ones((3, 2)), np.ones((4, 2)))
