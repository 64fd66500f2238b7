import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import optimize

from stages.core import key_weights


def face(seed, shapes=6, coordinates=20):
    rng = np.random.default_rng(seed)
    neutral = 3 + rng.normal(size=coordinates)
    return neutral, neutral + rng.normal(size=(shapes, coordinates)), rng


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000), st.sampled_from(["nonnegative_offset", "simplex", "least_squares"]))
def test_planted_weights_come_back(seed, method):
    neutral, shapes, rng = face(seed)
    planted = rng.dirichlet(np.ones(7), 12)[:, :6] * (rng.random((12, 6)) > 0.4)
    frames = neutral + planted @ (shapes - neutral)
    solution = key_weights.solve(frames, shapes, neutral, method)
    np.testing.assert_allclose(solution.weights, planted, atol=1e-6)
    np.testing.assert_allclose(solution.residual, 0, atol=1e-6)


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000))
def test_absolute_weights_are_those_of_equation_four(seed):
    neutral, shapes, rng = face(seed)
    frames = rng.dirichlet(np.ones(6), 4) @ shapes + 0.3 * rng.normal(size=(4, 20))
    solution = key_weights.solve(frames, shapes, neutral, "nonnegative_absolute")
    expected = [optimize.nnls(shapes.T, frame)[0] for frame in frames]
    np.testing.assert_allclose(solution.weights, expected, atol=1e-8)


@pytest.mark.parametrize("seed", range(4))
def test_simplex_is_the_constrained_minimum(seed):
    neutral, shapes, rng = face(seed, shapes=4, coordinates=8)
    frame = neutral + rng.normal(size=8)
    corners = np.vstack([neutral, shapes])
    found = key_weights.solve(frame[None], shapes, neutral, "simplex")
    best = optimize.minimize(
        lambda w: np.sum((frame - w @ corners) ** 2),
        np.full(5, 0.2),
        jac=lambda w: -2 * corners @ (frame - w @ corners),
        method="SLSQP",
        bounds=[(0, 1)] * 5,
        constraints={"type": "eq", "fun": lambda w: w.sum() - 1, "jac": np.ones_like},
        options={"ftol": 1e-15, "maxiter": 300},
    )
    np.testing.assert_allclose(found.weights[0], best.x[1:], atol=1e-6)
    assert found.kkt_residual[0] < 1e-9


def test_tolerant_solves_are_stationary_points_of_their_objectives():
    neutral, shapes, rng = face(1)
    frames, offsets = neutral + rng.normal(size=(5, 20)), shapes - neutral
    squares, sigma = np.sum(offsets**2, axis=1), 0.3
    own, shared = key_weights.even_errors(squares, sigma)
    for method, penalty in (
        ("tolerant", np.diag(sigma**2 * squares)),
        ("tolerant_even", np.diag(own) + shared),
    ):
        weights = key_weights.solve(frames, shapes, neutral, method, sigma, bound=9.0).weights
        slope = (weights @ offsets - (frames - neutral)) @ offsets.T + weights @ penalty
        np.testing.assert_allclose(slope, 0, atol=1e-9)


@pytest.mark.parametrize("method", key_weights.SOLVES)
def test_units_do_not_matter(method):
    neutral, shapes, rng = face(2)
    frames = neutral + rng.normal(size=(7, 20))
    small = key_weights.solve(frames, shapes, neutral, method, 0.2)
    large = key_weights.solve(100 * frames, 100 * shapes, 100 * neutral, method, 0.2)
    np.testing.assert_allclose(large.weights, small.weights, atol=1e-9)
    np.testing.assert_allclose(large.residual, 100 * small.residual, rtol=1e-9)


@pytest.mark.parametrize("method", set(key_weights.SOLVES) - {"nonnegative_absolute"})
def test_the_origin_does_not_matter_but_to_absolute_shapes(method):
    neutral, shapes, rng = face(3)
    frames = neutral + rng.normal(size=(7, 20))
    here = key_weights.solve(frames, shapes, neutral, method, 0.2).weights
    there = key_weights.solve(frames + 50, shapes + 50, neutral + 50, method, 0.2).weights
    np.testing.assert_allclose(there, here, atol=1e-7)


@pytest.mark.parametrize("method", key_weights.SOLVES)
@pytest.mark.parametrize("bound", [0.0, 0.15])
def test_bounds_hold_and_the_conditions_with_them(method, bound):
    neutral, shapes, rng = face(4)
    frames = neutral + 3 * rng.normal(size=(30, 20))
    solution = key_weights.solve(frames, shapes, neutral, method, 0.1, bound)
    assert solution.weights.max() <= 1 + bound + 1e-12
    assert solution.weights.min() >= -bound - 1e-12
    assert solution.kkt_residual.max() < 1e-9


def test_residual_is_the_distance_of_what_is_baked():
    neutral, shapes, rng = face(5)
    frames = neutral + rng.normal(size=(4, 20))
    weights, residual, _ = key_weights.solve(frames, shapes, neutral, "nonnegative_absolute")
    baked = (1 - weights.sum(axis=1))[:, None] * neutral + weights @ shapes
    np.testing.assert_allclose(residual, np.linalg.norm(frames - baked, axis=1))


def test_tolerance_spares_the_target_from_opposite_weights():
    neutral, shapes, rng = face(6)
    shapes = np.vstack([shapes, shapes[0] + 0.01 * rng.normal(size=20)])
    frames = neutral + rng.normal(size=(20, 20))
    size = [
        np.abs(key_weights.solve(frames, shapes, neutral, method, 0.1, bound=99).weights).max()
        for method in ("least_squares", "tolerant", "tolerant_even")
    ]
    assert size[0] > 5 * max(size[1:])


@pytest.mark.parametrize(
    ("frames", "method", "words"),
    [
        (np.zeros((2, 3)), "tolerant", r"\(2, 3\)"),
        (np.full((2, 20), np.nan), "tolerant", "NaN"),
        (np.zeros((2, 20)), "magic", "magic"),
    ],
)
def test_bad_input_is_refused(frames, method, words):
    neutral, shapes, _ = face(7)
    with pytest.raises(ValueError, match=words):
        key_weights.solve(frames, shapes, neutral, method)
