import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from stages.core import layer_composition, layer_model, layer_solver

COUNTS = (5, 4, 3)
LAYER = np.repeat([0, 1, 2], COUNTS)
SIZE = 72
MOUTH = 1
BEYOND = 0.7


def built(rng):
    basis = rng.normal(size=(SIZE, sum(COUNTS))) / np.sqrt(SIZE)
    # a neutral in each layer
    basis[:, [0, 5, 9]] = 0.0
    return layer_model.build(basis, LAYER, np.eye(3)[np.repeat([0, 1, 2], SIZE // 3)].T)


def shown(model, weights, coefficients, amplitudes):
    u = layer_composition.displacements(LAYER, weights, coefficients, amplitudes)
    return layer_composition.composed(model.basis, model.masks, u)


def spoken(rng, count):
    """Planted layers: the mouth holds 1.65, an emotion and speech in full, the eyes 1.2."""
    weights = np.tile(
        [[0.8, 0.2, 0.0], [0.65 / 1.65, 1 / 1.65, 0.0], [0.5, 0.0, 0.5]], (count, 1, 1)
    )
    parts = [rng.dirichlet(np.full(size, 0.4), count) for size in COUNTS]
    return weights, np.concatenate(parts, axis=1), np.tile([1.0, 1.65, 1.2], (count, 1))


def drawn(rng, count):
    parts = [rng.dirichlet(np.full(size, 0.4), count) for size in COUNTS]
    amplitudes = rng.uniform(1, 1 + BEYOND, (count, 3))
    return rng.dirichlet(np.ones(3), (count, 3)), np.concatenate(parts, axis=1), amplitudes


def solved(model, frames, beyond=BEYOND, temporal=0.0):
    settings = layer_solver.Settings(temporal, beyond)
    return layer_solver.solve(model, settings, frames, np.zeros(len(frames)))


def composed(model, found):
    return shown(model, found.weights, found.coefficients, found.amplitudes)


def test_speech_and_an_emotion_in_one_mouth_are_found_only_beyond_one():
    rng = np.random.default_rng(0)
    model = built(rng)
    frames = shown(model, *spoken(rng, 30))
    size = np.sqrt(np.mean(frames**2))
    soft, hard = (composed(model, solved(model, frames, beyond)) for beyond in (BEYOND, 0.0))
    assert np.sqrt(np.mean((soft - frames) ** 2)) < 0.02 * size
    assert np.sqrt(np.mean((hard - frames) ** 2)) > 0.1 * size


def test_amplitudes_follow_what_is_too_large():
    rng = np.random.default_rng(9)
    model = built(rng)
    weights, coefficients, _ = drawn(rng, 10)
    frames = 1.3 * shown(model, weights, coefficients, np.ones((10, 3)))
    hard, soft = solved(model, frames, 0.0), solved(model, frames, 0.5)
    np.testing.assert_array_equal(hard.amplitudes, 1.0)
    assert soft.data.sum() < 0.01 * hard.data.sum()


def test_what_is_within_one_stays_so():
    rng = np.random.default_rng(1)
    model = built(rng)
    weights, coefficients, _ = drawn(rng, 10)
    frames = shown(model, weights, coefficients, np.ones((10, 3)))
    soft = solved(model, frames)
    np.testing.assert_allclose(composed(model, soft), frames, atol=1e-4)
    assert np.median(soft.amplitudes) == 1.0


def cost(model, frame, before, temporal, v, coefficients):
    """Write out the objective of what is shown, v = s w, and the ridge on its sums."""
    u = v[:, LAYER] * coefficients
    shape = layer_composition.composed(model.basis, model.masks, u[None])[0]
    ridge = layer_solver.SOFTNESS * model.scale * np.sum((v.sum(axis=1) - 1) ** 2)
    change = 0.0
    if before is not None:
        held = before.amplitudes[:, None] * before.weights
        change = np.sum((v - held) ** 2) + np.sum((coefficients - before.coefficients) ** 2)
    return np.sum((frame - shape) ** 2) + ridge + temporal * change


@hypothesis.given(
    seed=st.integers(0, 2**32 - 1),
    temporal=st.sampled_from([0.0, 0.05, 1.0]),
    beyond=st.sampled_from([1e-6, 0.3, BEYOND]),
)
@hypothesis.settings(max_examples=25, deadline=None)
def test_bounds_hold_and_no_near_mix_is_better(seed, temporal, beyond):
    rng = np.random.default_rng(seed)
    model = built(rng)
    frames = shown(model, *drawn(rng, 3)) + 0.3 * rng.normal(size=(3, SIZE)) / np.sqrt(SIZE)
    settings, hard = layer_solver.Settings(temporal, beyond), layer_solver.Settings(temporal)
    state = None
    for frame in frames:
        before = state
        at_one, _ = layer_solver.solve_frame(model, hard, frame, 0.0, before)
        found, state = layer_solver.solve_frame(model, settings, frame, 0.0, before)
        assert found.amplitudes.min() >= 1.0 and found.amplitudes.max() <= 1.0 + beyond
        assert found.weights.min() >= 0.0
        np.testing.assert_allclose(found.weights.sum(axis=1), 1)
        np.testing.assert_allclose(np.bincount(LAYER, found.coefficients), 1)
        # what is certified is the best at amplitude one
        for name in ("objective", "bound", "outside"):
            assert getattr(found, name) == getattr(at_one, name)
        given = (model, frame, before, temporal)
        v = found.amplitudes[:, None] * found.weights
        reached = cost(*given, v, found.coefficients)
        assert reached <= cost(*given, at_one.weights, at_one.coefficients) + 1e-9
        # given the coefficients the rest is convex: no other mix within the bounds is better, but
        # where a mask was shut for good
        for _ in range(20):
            sums = rng.choice([1.0, 1.0 + beyond, rng.uniform(1, 1 + beyond)], 3)
            other = rng.dirichlet(np.ones(3), 3) * sums[:, None]
            kept = rng.uniform(0.5, 1)
            near = kept * v + (1 - kept) * other
            assert reached <= cost(*given, near, found.coefficients) + 1e-4


def test_what_is_held_of_the_last_frame_is_what_it_showed():
    rng = np.random.default_rng(2)
    model = built(rng)
    frame = shown(model, *spoken(rng, 1))
    found = solved(model, np.repeat(frame, 60, axis=0), temporal=1.0)
    assert found.data[-1] < 1e-3 * np.sum(frame**2)
    assert found.amplitudes[-1, MOUTH] > 1.05


def test_a_mask_in_which_nothing_moves_stays_at_one():
    rng = np.random.default_rng(3)
    model = built(rng)
    basis = np.where(model.masks[2][:, None] > 0, 0.0, model.basis)
    model = layer_model.build(basis, LAYER, model.masks)
    found = solved(model, shown(model, *spoken(rng, 5)), temporal=0.05)
    np.testing.assert_array_equal(found.amplitudes[:, 2], 1.0)
    assert found.amplitudes[:, MOUTH].min() > 1.0


@pytest.mark.parametrize("beyond", [-0.1, np.nan, np.inf])
def test_refuses_a_bound_without_meaning(beyond):
    model = built(np.random.default_rng(4))
    with pytest.raises(ValueError, match="beyond"):
        solved(model, np.zeros((1, SIZE)), beyond)
