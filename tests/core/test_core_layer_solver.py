import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from stages.core import layer_model, layer_objective, layer_published, layer_solver, layer_starts

COUNTS = (5, 4, 3)
LAYER = np.repeat([0, 1, 2], COUNTS)
SPEECH, MOUTH, CLOSED = 1, 1, 6
SIZE = 72
# the lips of two emotions, of the rest of speech and of one blink are closed, as those of /m/ are
GAPS = np.array([0.0, 0.0, 0.3, 0.1, 0.2, 0.0, 0.0, 0.4, 0.2, 0.0, 0.1, 0.1])[None]


def sharp_masks():
    return np.eye(3)[np.repeat([0, 1, 2], SIZE // 3)].T


def soft_masks(rng):
    return rng.dirichlet(np.ones(3), SIZE).T


def built(rng, masks=None, bias=True):
    basis = rng.normal(size=(SIZE, sum(COUNTS))) / np.sqrt(SIZE)
    lips = (MOUTH, SPEECH, CLOSED, GAPS) if bias else (-1, -1, -1)
    return layer_model.build(basis, LAYER, sharp_masks() if masks is None else masks, *lips)


def drawn(rng, count):
    weights = rng.dirichlet(np.ones(3), (count, 3))
    parts = [rng.dirichlet(np.full(size, 0.4), count) for size in COUNTS]
    return weights, np.concatenate(parts, axis=1)


def composed(model, weights, coefficients):
    layers = model.basis[:, :, None] * np.eye(weights.shape[2])[model.layer]
    shapes = np.einsum("dkj,tk->tjd", layers, coefficients)
    return np.einsum("ld,tlj,tjd->td", model.masks, weights, shapes)


def moving_shares(model):
    """How much each layer's extremes move under each mask, of what all do."""
    squares = np.array([np.sum((mask[:, None] * model.basis) ** 2, 0) for mask in model.masks])
    means = np.stack([squares[:, model.layer == j].mean(axis=1) for j in range(3)], axis=1)
    return means / means.sum(axis=1, keepdims=True)


def cost(model, settings, frame, closeness, previous, weights, coefficients):
    """The objective, written out as in the method."""
    known = ~np.isnan(frame)
    shape = composed(model, weights[None], coefficients[None])[0]
    yields = {"mouth": model.masks[MOUTH], "published": 1.0, "gap": 0.0}[settings.lip_bias]
    data = np.sum(((1 - closeness * yields) * (frame - shape) ** 2)[known])
    spoken = model.layer == SPEECH
    closed = np.arange(len(model.layer)) == CLOSED
    lips = np.sum((weights[MOUTH] - [0, 1, 0]) ** 2)
    lips += np.sum((coefficients - closed)[spoken] ** 2)
    if settings.lip_bias == "gap":
        gap = np.sum(weights[MOUTH][LAYER] * coefficients * GAPS[0])
        lips = model.scale * gap**2 / np.mean(GAPS**2) / (1.02 - closeness)
    leant = settings.lean * np.sum((weights - moving_shares(model)) ** 2)
    change = 0.0
    if previous is not None:
        change = np.sum((weights - previous.weights) ** 2)
        change += np.sum((coefficients - previous.coefficients) ** 2)
    return data + closeness * lips + settings.temporal * change + leant


@pytest.mark.parametrize("soft", [False, True])
def test_finds_planted_layers(soft):
    rng = np.random.default_rng(0)
    model = built(rng, soft_masks(rng) if soft else None)
    weights, coefficients = drawn(rng, 40)
    frames = composed(model, weights, coefficients)
    found = layer_solver.solve(model, layer_solver.Settings(0.0), frames, np.zeros(40))
    np.testing.assert_allclose(found.weights, weights, atol=1e-3)
    np.testing.assert_allclose(found.coefficients, coefficients, atol=1e-3)
    assert np.all(found.objective - found.bound < 1e-6)
    assert np.all(found.outside < 1e-3)


@hypothesis.given(
    seed=st.integers(0, 2**32 - 1),
    closeness=st.sampled_from([0.0, 0.3, 1.0]),
    temporal=st.sampled_from([0.0, 0.05, 1.0]),
    soft=st.booleans(),
    lip_bias=st.sampled_from(layer_solver.LIP_BIASES),
    lean=st.sampled_from([0.0, 0.03]),
    missing=st.sampled_from([0, 9]),
)
@hypothesis.settings(max_examples=25, deadline=None)
def test_is_feasible_and_certified(seed, closeness, temporal, soft, lip_bias, missing, lean):
    rng = np.random.default_rng(seed)
    model = built(rng, soft_masks(rng) if soft else None)
    settings = layer_solver.Settings(temporal, lip_bias=lip_bias, lean=lean)
    frames = composed(model, *drawn(rng, 3)) + 0.3 * rng.normal(size=(3, SIZE)) / np.sqrt(SIZE)
    frames[1, rng.permutation(SIZE)[:missing]] = np.nan
    state = None
    for frame in frames:
        previous = state
        found, state = layer_solver.solve_frame(model, settings, frame, closeness, previous)
        assert np.all(found.weights >= 0) and np.all(found.coefficients >= 0)
        np.testing.assert_allclose(found.weights.sum(axis=1), 1)
        np.testing.assert_allclose(np.bincount(LAYER, found.coefficients), 1)
        given = (model, settings, frame, closeness, previous)
        assert found.objective == pytest.approx(
            cost(*given, found.weights, found.coefficients), abs=1e-9
        )
        drawn_costs = [cost(*given, w, a) for w, a in zip(*drawn(rng, 50), strict=True)]
        assert found.objective <= min(drawn_costs) + 1e-12
        # the bound must hold at whatever point, those near the solution above all
        near = 0.05 * drawn(rng, 20)[0] + 0.95 * found.weights
        costs = [cost(*given, w, found.coefficients) for w in near]
        assert found.bound <= min(*costs, *drawn_costs, found.objective) + 1e-12


def test_lean_takes_the_say_from_layers_that_move_nothing():
    rng = np.random.default_rng(3)
    basis = rng.normal(size=(SIZE, sum(COUNTS)))
    # a neutral in each layer, and no speech under the last mask
    basis[:, [0, 5, 9]] = 0.0
    basis[-SIZE // 3 :, LAYER == SPEECH] = 0.0
    model = layer_model.build(basis, LAYER, sharp_masks())
    weights, coefficients = drawn(rng, 20)
    frames = composed(model, weights, coefficients)
    free, leant = (
        layer_solver.solve(model, layer_solver.Settings(0.0, lean=lean), frames, np.zeros(20))
        for lean in (0.0, 1.0)
    )
    assert leant.weights[:, 2, SPEECH].mean() < 0.4 * free.weights[:, 2, SPEECH].mean()
    assert np.mean(leant.data) < 0.02 * np.mean(frames**2) * SIZE


def test_is_as_good_as_many_starts():
    rng = np.random.default_rng(1)
    model = built(rng)
    frames = composed(model, *drawn(rng, 12)) + 0.4 * rng.normal(size=(12, SIZE)) / np.sqrt(SIZE)
    found = layer_solver.solve(model, layer_solver.Settings(0.0), frames, np.zeros(12))
    worse = 0
    for frame, value, bound in zip(frames, found.objective, found.bound, strict=True):
        quadratic = layer_model.project(model, frame)
        objective = layer_objective.at(model, quadratic, quadratic, 0.0, 0.0, None)
        ends = [
            layer_published.sequential(model, objective, start)
            for start in layer_starts.draws(model, 15, 3)
        ]
        best = min(layer_objective.value(model, objective, end) for end in ends)
        assert bound <= best + 1e-9
        worse += value > best + 1e-5
    assert worse <= 1


@hypothesis.given(seed=st.integers(0, 2**32 - 1))
@hypothesis.settings(max_examples=10, deadline=None)
def test_is_never_above_the_best_single_layer(seed):
    rng = np.random.default_rng(seed)
    model = built(rng)
    frames = rng.normal(size=(6, SIZE)) / np.sqrt(SIZE)
    found = layer_solver.solve(model, layer_solver.Settings(0.0), frames, np.zeros(6))
    for frame, data in zip(frames, found.data, strict=True):
        for layer in range(3):
            own = np.where(layer == LAYER)[0]
            alone = layer_model.build(model.basis[:, own], 0 * own, np.ones((1, SIZE)))
            single, _ = layer_solver.solve_frame(alone, layer_solver.Settings(0.0), frame)
            assert data <= single.data + 1e-8


@pytest.mark.parametrize("lip_bias", layer_solver.LIP_BIASES)
def test_live_is_the_same_as_a_sequence(lip_bias):
    rng = np.random.default_rng(2)
    model = built(rng)
    settings = layer_solver.Settings(0.05, 0.3, lip_bias)
    frames = 1.2 * composed(model, *drawn(rng, 8))
    frames[3, :5] = np.nan
    frames[5] = np.nan
    closeness = rng.uniform(size=8)
    whole = layer_solver.solve(model, settings, frames, closeness)
    again = layer_solver.solve(model, settings, frames, closeness)
    state = None
    for t, frame in enumerate(frames):
        one, state = layer_solver.solve_frame(model, settings, frame, closeness[t], state)
        for part, same, alone in zip(whole, again, one, strict=True):
            np.testing.assert_array_equal(part[t], alone)
            np.testing.assert_array_equal(part[t], same[t])


def test_drops_missing_coordinates_exactly():
    rng = np.random.default_rng(3)
    for masks in (sharp_masks(), soft_masks(rng)):
        model = built(rng, masks)
        frame = rng.normal(size=SIZE) / np.sqrt(SIZE)
        kept = rng.permutation(SIZE)[: SIZE - 20]
        missing = np.full(SIZE, np.nan)
        missing[kept] = frame[kept]
        settings = layer_solver.Settings(0.05)
        smaller = layer_model.build(model.basis[kept], LAYER, masks[:, kept], MOUTH, SPEECH, CLOSED)
        found, _ = layer_solver.solve_frame(model, settings, missing, 0.2)
        same, _ = layer_solver.solve_frame(smaller, settings, frame[kept], 0.2)
        for one, other in zip(found, same, strict=True):
            np.testing.assert_allclose(one, other, atol=1e-6)


def test_keeps_the_state_over_frames_that_were_not_observed():
    rng = np.random.default_rng(4)
    model = built(rng)
    frames = composed(model, *drawn(rng, 3))
    frames[1, : SIZE // 2 + 1] = np.nan
    settings = layer_solver.Settings(0.1)
    found = layer_solver.solve(model, settings, frames, np.zeros(3))
    without = layer_solver.solve(model, settings, frames[[0, 2]], np.zeros(2))
    for part, other in zip(found, without, strict=True):
        assert np.isnan(part[1]).all()
        np.testing.assert_array_equal(part[[0, 2]], other)


def test_revives_a_dead_layer():
    rng = np.random.default_rng(5)
    model = built(rng)
    weights, coefficients = drawn(rng, 1)
    dead = layer_solver.State(np.tile([1.0, 0.0, 0.0], (3, 1)), coefficients[0], np.ones(3))
    frame = composed(model, weights, coefficients)[0]
    found, _ = layer_solver.solve_frame(model, layer_solver.Settings(0.0), frame, 0.0, dead)
    np.testing.assert_allclose(found.weights, weights[0], atol=1e-3)


def test_holds_what_nothing_determines():
    rng = np.random.default_rng(6)
    model = built(rng)
    weights, coefficients = drawn(rng, 2)
    weights[1, :, 2] = 0.0
    weights[1] /= weights[1].sum(axis=1, keepdims=True)
    frames = composed(model, weights, coefficients)
    found = layer_solver.solve(model, layer_solver.Settings(0.0), frames, np.zeros(2))
    np.testing.assert_allclose(found.weights[1], weights[1], atol=1e-5)
    np.testing.assert_array_equal(found.coefficients[1, -3:], found.coefficients[0, -3:])


def test_closed_lips_bring_the_mouth_to_its_viseme():
    rng = np.random.default_rng(7)
    model = built(rng)
    frame = composed(model, *drawn(rng, 1))[0]
    found, _ = layer_solver.solve_frame(model, layer_solver.Settings(0), frame, 1)
    np.testing.assert_allclose(found.weights[MOUTH], [0, 1, 0], atol=1e-7)
    assert found.coefficients[CLOSED] == pytest.approx(1, abs=1e-7)
    slack, _ = layer_solver.solve_frame(model, layer_solver.Settings(0.0), frame, 0.5)
    free, _ = layer_solver.solve_frame(model, layer_solver.Settings(0.0), frame, 0.0)
    assert free.weights[MOUTH, 1] < slack.weights[MOUTH, 1] < 1


def test_closed_lips_need_not_hold_the_rest_of_the_face():
    rng = np.random.default_rng(7)
    model = built(rng)
    weights, coefficients = drawn(rng, 2)
    weights[:, MOUTH] = [0, 1, 0]
    coefficients[:, LAYER == SPEECH] = np.arange(len(LAYER))[LAYER == SPEECH] == CLOSED
    frames = composed(model, weights, coefficients)
    errors = []
    for lip_bias in ("published", "mouth"):
        settings = layer_solver.Settings(0.05, lip_bias=lip_bias)
        found = layer_solver.solve(model, settings, frames, np.array([0.0, 1.0]))
        shape = composed(model, found.weights, found.coefficients)
        errors.append(np.linalg.norm(shape[1] - frames[1]))
    assert errors[1] < 0.5 * errors[0]


def test_temporal_weight_slows_what_changes():
    rng = np.random.default_rng(8)
    model = built(rng)
    frames = composed(model, *drawn(rng, 20))
    changes = []
    for temporal in (0.0, 0.1, 10.0):
        found = layer_solver.solve(model, layer_solver.Settings(temporal), frames, np.zeros(20))
        changes.append(np.abs(np.diff(found.weights, axis=0)).mean())
    assert changes[0] > changes[1] > changes[2]


@pytest.mark.parametrize(
    ("frames", "closeness", "settings", "words"),
    [
        (np.zeros((2, SIZE - 1)), np.zeros(2), (0.0, 0.0), "expected frames"),
        (np.zeros((2, SIZE)), np.zeros(3), (0.0, 0.0), "expected frames"),
        (np.zeros((0, SIZE)), np.zeros(0), (0.0, 0.0), "at least one"),
        (np.full((1, SIZE), np.inf), np.zeros(1), (0.0, 0.0), "finite"),
        (np.zeros((1, SIZE)), np.full(1, 1.5), (0.0, 0.0), "closeness"),
        (np.zeros((1, SIZE)), np.full(1, np.nan), (0.0, 0.0), "closeness"),
        (np.zeros((1, SIZE)), np.ones(1), (0.0, 0.0), "lip mask"),
        (np.zeros((1, SIZE)), np.zeros(1), (0.0, 0.0, "eyes"), "lip_bias"),
        (np.zeros((1, SIZE)), np.zeros(1), (-1.0, 0.0), "temporal"),
        (np.zeros((1, SIZE)), np.zeros(1), (0.0, np.inf), "beyond"),
    ],
)
def test_refuses_what_does_not_fit(frames, closeness, settings, words):
    model = built(np.random.default_rng(0), bias=False)
    with pytest.raises(ValueError, match=words):
        layer_solver.solve(model, layer_solver.Settings(*settings), frames, closeness)
