import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import equation

SEEDS = st.integers(0, 10_000)
PROPORTIONS = np.array([1.3, 0.8, 1.1])


def take(seed, frames=20, shapes=6, points=9, axes=3, low=0.1, high=0.9):
    """Return an actor whose points are a model's in other proportions, and its weights."""
    rng = np.random.default_rng(seed)
    places = rng.normal(size=(points, axes))
    deltas = 0.1 * rng.normal(size=(shapes, points, axes))
    weights = rng.uniform(low, high, (frames, shapes))
    scale = PROPORTIONS[:axes]
    neutral = places / scale + 0.3
    moved = neutral + np.tensordot(weights, deltas, axes=1) / scale
    return weights, moved, neutral, places, deltas


def smooth_weights(frames, shapes, seed=0):
    rng = np.random.default_rng(seed)
    time = np.linspace(0, 3, frames)[:, None]
    return 0.5 + 0.6 * np.sin(time * rng.uniform(1, 4, shapes) + rng.uniform(0, 6, shapes))


@given(SEEDS)
def test_proportions_are_those_the_model_was_made_with(seed):
    _, _, neutral, places, _ = take(seed)
    np.testing.assert_allclose(equation.proportions(neutral, places), PROPORTIONS)


@settings(deadline=None, max_examples=20)
@given(SEEDS, st.sampled_from(equation.METHODS), st.sampled_from([2, 3]))
def test_every_solve_finds_weights_that_explain_the_points(seed, method, axes):
    weights, *arrays = take(seed, axes=axes, shapes=5)
    solution = equation.solve(*arrays, method, strength=0.0)
    np.testing.assert_allclose(solution.weights, weights, atol=2e-3)
    np.testing.assert_allclose(solution.residual, 0, atol=1e-4)
    assert solution.kkt_residual.max() < 1e-4


def test_a_face_of_other_form_spoils_positions_but_not_displacements():
    weights, moved, neutral, places, deltas = take(1)
    rng = np.random.default_rng(0)
    other = neutral + 0.1 * rng.normal(size=neutral.shape)
    moved = moved + other - neutral
    scale = equation.proportions(other, places) / PROPORTIONS
    errors = {
        method: np.abs(
            equation.solve(moved, other, places, deltas / scale, method).weights - weights
        ).mean()
        for method in ("positions", "displacements")
    }
    assert errors["positions"] > 5 * errors["displacements"]


def test_bounds_are_kept_and_least_squares_leave_them():
    _, *arrays = take(3, low=-0.5, high=1.5)
    assert equation.solve(*arrays, "displacements").weights.max() > 1.2
    solution = equation.solve(*arrays, "bounded", lower=-0.1, upper=0.6)
    assert solution.weights.min() == -0.1
    assert solution.weights.max() == 0.6
    assert solution.kkt_residual.max() < equation.FRAME_TOLERANCE


@pytest.mark.parametrize("method", equation.METHODS)
def test_size_of_the_meshes_means_nothing(method):
    _, moved, neutral, places, deltas = take(4)
    moved = moved + 0.05 * np.random.default_rng(1).normal(size=moved.shape)
    first = equation.solve(moved, neutral, places, deltas, method, strength=3.0)
    large = equation.solve(*(100 * a for a in (moved, neutral, places, deltas)), method, strength=3)
    np.testing.assert_allclose(large.weights, first.weights, atol=1e-8)
    np.testing.assert_allclose(large.residual, 100 * first.residual, rtol=1e-5)


@pytest.mark.parametrize("method", equation.METHODS)
def test_points_not_observed_are_left_out(method):
    weights, moved, neutral, places, deltas = take(5, frames=40, points=12)
    rng = np.random.default_rng(2)
    gappy = moved.copy()
    gappy[rng.random(gappy.shape[:2]) < 0.15] = np.nan
    gappy[7:10] = np.nan
    gappy[20, :8] = np.nan
    solution = equation.solve(gappy, neutral, places, deltas, method, strength=0.0)
    lost = np.isin(np.arange(40), [7, 8, 9, 20])
    assert np.isnan(solution.weights[lost]).all()
    assert np.isnan(solution.residual[lost]).all()
    np.testing.assert_allclose(solution.weights[~lost], weights[~lost], atol=5e-3)


def test_strength_means_the_same_at_any_rate():
    weights = smooth_weights(240, 3)
    _, _, neutral, places, deltas = take(6, shapes=3)
    found = {}
    for rate, step in ((60.0, 1), (30.0, 2)):
        slow = neutral + np.tensordot(weights[::step], deltas, axes=1) / PROPORTIONS
        found[rate] = equation.solve(
            slow, neutral, places, deltas, "clip", -5.0, 5.0, strength=4000.0, rate=rate
        ).weights
    inside = slice(20, -20)
    blunted = np.abs(found[60.0] - weights)[::2][inside].max()
    apart = np.abs(found[30.0] - found[60.0][::2])[inside].max()
    assert apart < 0.1 * blunted


def test_more_shapes_than_coordinates_still_have_one_answer():
    weights, *arrays = take(7, shapes=40, points=6)
    first = equation.solve(*arrays, "bounded")
    order = np.random.default_rng(0).permutation(40)
    moved, neutral, places, deltas = arrays
    shuffled = equation.solve(moved, neutral, places, deltas[order], "bounded")
    np.testing.assert_allclose(shuffled.weights, first.weights[:, order], atol=1e-4)
    assert first.kkt_residual.max() < equation.FRAME_TOLERANCE


def test_a_clip_is_cut_at_long_gaps_and_bridged_over_short_ones():
    _, moved, neutral, places, deltas = take(8, frames=80)
    moved[10:12], moved[30:50] = np.nan, np.nan
    whole = equation.solve(moved, neutral, places, deltas, "clip", rate=15.0).weights
    alone = equation.solve(moved[50:], neutral, places, deltas, "clip", rate=15.0).weights
    np.testing.assert_allclose(whole[50:], alone, atol=1e-12)
    assert np.isnan(whole[30:50]).all()
    assert np.isnan(whole[10:12]).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"method": "best"}, "no solve is called 'best'"),
        ({"deltas": np.zeros((6, 9, 3))}, "moves any"),
        ({"deltas": np.zeros((6, 8, 3))}, "do not fit"),
        ({"places": np.ones((9, 3))}, "extent"),
        ({"places": np.ones((8, 3))}, "do not correspond"),
        ({"lower": 2.0}, "above their upper"),
    ],
)
def test_what_does_not_fit_is_refused(change, message):
    _, moved, neutral, places, deltas = take(0)
    given = {"points": moved, "neutral": neutral, "places": places, "deltas": deltas}
    with pytest.raises(ValueError, match=message):
        equation.solve(**({**given, "method": "clip"} | change))
