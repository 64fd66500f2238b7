import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import optimize

from stages.core import box_least_squares

SEEDS = st.integers(0, 10_000)


def problem(seed, columns, rows, frames=6):
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(rows, columns)) + rng.normal(size=(rows, 1))
    return matrix, rng.normal(size=(frames, columns)) @ matrix.T + rng.normal(size=(frames, rows))


@settings(deadline=None, max_examples=40)
@given(SEEDS, st.integers(1, 12))
def test_non_negative_solve_is_that_of_scipy(seed, columns):
    matrix, targets = problem(seed, columns, 15)
    upper = np.full(columns, np.inf)
    weights = box_least_squares.solve(matrix, targets, np.zeros(columns), upper)
    expected = [optimize.nnls(matrix, target)[0] for target in targets]
    np.testing.assert_allclose(weights, expected, atol=1e-8)


@settings(deadline=None, max_examples=40)
@given(SEEDS, st.integers(1, 8))
def test_bounded_solve_is_that_of_scipy(seed, columns):
    matrix, targets = problem(seed, columns, 12, frames=3)
    rng = np.random.default_rng(seed)
    lower = -rng.uniform(0, 1, columns)
    upper = lower + rng.uniform(0, 1, columns) * rng.integers(0, 2, columns)
    weights = box_least_squares.solve(matrix, targets, lower, upper)
    free = upper > lower
    np.testing.assert_array_equal(weights[:, ~free], np.tile(lower[~free], (3, 1)))
    for target, found in zip(targets, weights, strict=True):
        if free.any():
            rest = target - matrix[:, ~free] @ lower[~free]
            bounds = (lower[free], upper[free])
            best = optimize.lsq_linear(matrix[:, free], rest, bounds, method="bvls", tol=1e-14)
            np.testing.assert_allclose(found[free], best.x, atol=1e-7)


@pytest.mark.parametrize("columns", [30, 60])
def test_both_ways_through_the_frames_satisfy_the_conditions(columns):
    matrix, targets = problem(3, columns, 50, frames=8)
    lower, upper = np.full(columns, -0.2), np.full(columns, 0.7)
    weights = box_least_squares.solve(matrix, targets, lower, upper)
    assert weights.min() >= -0.2
    assert weights.max() <= 0.7
    assert (weights == 0.7).any()
    assert box_least_squares.kkt_residual(matrix, targets, lower, upper, weights).max() < 1e-9


def test_any_start_leads_to_the_same_minimum():
    matrix, targets = problem(5, 10, 20, frames=1)
    gram, linear = matrix.T @ matrix, matrix.T @ targets[0]
    lower, upper = np.zeros(10), np.full(10, 0.4)
    starts = np.random.default_rng(1).uniform(0, 0.4, (20, 10))
    found = [box_least_squares.solve_gram(gram, linear, lower, upper, start) for start in starts]
    np.testing.assert_allclose(found, np.tile(found[0], (20, 1)), atol=1e-12)


def test_columns_that_depend_on_one_another_or_vanish_still_give_a_minimum():
    matrix, targets = problem(7, 4, 10)
    matrix = np.hstack([matrix, matrix[:, :2], np.zeros((10, 1))])
    lower, upper = np.zeros(7), np.full(7, np.inf)
    weights = box_least_squares.solve(matrix, targets, lower, upper)
    assert box_least_squares.kkt_residual(matrix, targets, lower, upper, weights).max() < 1e-8
    np.testing.assert_array_equal(weights[:, 6], 0)


def test_kkt_residual_sees_a_weight_that_should_move():
    matrix, targets = problem(9, 5, 12)
    lower, upper = np.zeros(5), np.full(5, np.inf)
    weights = box_least_squares.solve(matrix, targets, lower, upper)
    wrong = weights + np.eye(5)[0] * 0.25
    assert box_least_squares.kkt_residual(matrix, targets, lower, upper, wrong).min() > 0.2


def test_reduction_keeps_every_distance():
    matrix, targets = problem(11, 4, 9)
    R, z, rest = box_least_squares.reduce(matrix, targets)
    weights = np.random.default_rng(2).normal(size=(6, 4))
    full = np.sum((weights @ matrix.T - targets) ** 2, axis=1)
    np.testing.assert_allclose(np.sum((weights @ R.T - z) ** 2, axis=1) + rest**2, full)


@pytest.mark.parametrize(
    ("targets", "lower"), [(np.zeros((2, 4)), np.zeros(2)), (np.zeros((2, 5)), np.full(2, 2.0))]
)
def test_what_does_not_fit_is_refused(targets, lower):
    with pytest.raises(ValueError, match=r"\(5, 2\)"):
        box_least_squares.solve(np.ones((5, 2)), targets, lower, np.ones(2))
