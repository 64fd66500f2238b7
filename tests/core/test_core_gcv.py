import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import gcv, rbf


def drawn(seed, width=1.0, rows=40, noise=0.1):
    """Return Gaussians round the examples, and targets of several kinds."""
    rng = np.random.default_rng(seed)
    places = rng.normal(size=(rows, 3))
    kinds = [np.sin(2 * places[:, 0]), places[:, 0] * places[:, 1], places[:, 2], 0 * places[:, 0]]
    targets = np.stack(kinds, axis=1) + noise * rng.normal(size=(rows, 4)) * [1, 1, 1, 9]
    return rbf.basis(places, places, width), targets


def brute_force(design, free, targets, values):
    """Return the criterion for each value, from the published formulas as they stand."""
    rows = len(design)
    outside = np.eye(rows) - free @ np.linalg.pinv(free)
    found = []
    for value in values:
        inner = outside @ design
        system = inner.T @ inner + value * np.eye(design.shape[1])
        projection = outside - inner @ np.linalg.solve(system, inner.T)
        misfit = np.sum((projection @ targets) ** 2, axis=0)
        found.append(rows * misfit / np.trace(projection) ** 2)
    return np.array(found)


@settings(deadline=None, max_examples=10)
@given(st.integers(0, 10_000), st.sampled_from([0.3, 0.7, 1.5]), st.booleans())
def test_no_lambda_of_a_fine_grid_is_better(seed, width, constant):
    design, targets = drawn(seed, width)
    free = np.ones((len(design), 1)) if constant else np.zeros((len(design), 0))
    parts = gcv.decompose(design, free)
    chosen = gcv.choose(parts, targets)
    grid = parts.singular[0] ** 2 * np.logspace(-9, 2, 400)
    best = brute_force(design, free, targets, grid).min(axis=0)
    reached = gcv.score(parts, targets, chosen)
    assert (reached <= best * (1 + 1e-4)).all()
    for column, value in enumerate(chosen):
        if value > grid[0]:
            own = brute_force(design, free, targets[:, [column]], [value])
            np.testing.assert_allclose(own[0, 0], reached[column], rtol=1e-5)


def test_a_smooth_target_gets_a_smaller_lambda_than_noise():
    design, targets = drawn(3, 1.0, noise=0.05)
    chosen = gcv.choose(gcv.decompose(design), targets)
    assert chosen[0] < chosen[3] / 100


def test_what_the_free_columns_explain_is_smoothed_most():
    design, _ = drawn(4)
    parts = gcv.decompose(design, np.ones((40, 1)))
    targets = np.stack([np.zeros(40), np.full(40, 0.3)], axis=1)
    lambdas = gcv.choose(parts, targets)
    free, weights = gcv.solve(parts, targets, lambdas)
    np.testing.assert_allclose(free, [[0, 0.3]], atol=1e-9)
    np.testing.assert_allclose(weights, 0, atol=1e-9)


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 10_000), st.floats(1e-4, 10))
def test_equation_six_and_leaving_one_out_agree_with_explicit_refits(seed, value):
    design, targets = drawn(seed, rows=15)
    free = np.ones((15, 1))
    parts = gcv.decompose(design, free)
    lambdas = np.full(4, value)
    _, weights = gcv.solve(gcv.decompose(design), targets, lambdas)
    explicit = np.linalg.solve(design.T @ design + value * np.eye(15), design.T @ targets)
    np.testing.assert_allclose(weights, explicit, atol=1e-8)
    left_out = gcv.leave_one_out(parts, targets, lambdas)
    for row in range(15):
        rest = np.delete(np.arange(15), row)
        constant, own = gcv.solve(gcv.decompose(design[rest], free[rest]), targets[rest], lambdas)
        predicted = constant[0] + design[row] @ own
        np.testing.assert_allclose(left_out[row], targets[row] - predicted, atol=1e-6)


def test_a_kernel_is_a_design():
    design, targets = drawn(5, rows=20)
    free = np.ones((20, 1))
    whole, kernel = gcv.decompose(design, free), gcv.decompose_kernel(design @ design.T, free)
    lambdas = np.full(4, 0.3)
    for function in (gcv.score, gcv.leave_one_out):
        one, other = (function(parts, targets, lambdas) for parts in (whole, kernel))
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-9)
    dual = gcv.dual(kernel, gcv.solve(kernel, targets, lambdas)[1])
    np.testing.assert_allclose(
        design.T @ dual, gcv.solve(whole, targets, lambdas)[1], rtol=1e-5, atol=1e-7
    )


def test_too_many_free_columns_are_refused():
    with pytest.raises(ValueError, match=r"\(4, 2\).*\(4, 4\)"):
        gcv.decompose(np.ones((4, 2)), np.eye(4))
