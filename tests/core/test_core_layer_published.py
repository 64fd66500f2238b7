import numpy as np
import pytest
import scipy.optimize

from stages.core import layer_model, layer_objective, layer_published, layer_search, layer_solver

LAYER = np.repeat([0, 1, 2], (4, 3, 2))
SIZE = 45


def built(rng):
    basis = rng.normal(size=(SIZE, len(LAYER))) / np.sqrt(SIZE)
    masks = np.eye(3)[np.repeat([0, 1, 2], SIZE // 3)].T
    return layer_model.build(basis, LAYER, masks, 1, 1, 5)


def test_gradient_is_that_of_the_objective():
    rng = np.random.default_rng(0)
    model = built(rng)
    frame = rng.normal(size=SIZE) / np.sqrt(SIZE)
    before, point = rng.uniform(size=(2, len(model.group)))
    quadratic = layer_model.project(model, frame)
    objective = layer_objective.at(model, quadratic, quadratic, 0.3, 0.2, before)
    numeric = scipy.optimize.approx_fprime(
        point, lambda at: layer_objective.value(model, objective, at), 1e-7
    )
    np.testing.assert_allclose(
        layer_published.gradient(model, objective, point), numeric, atol=1e-6
    )


def test_both_solvers_meet_from_the_same_start():
    rng = np.random.default_rng(1)
    model = built(rng)
    worse = 0
    for _ in range(10):
        frame = rng.normal(size=SIZE) / np.sqrt(SIZE)
        start = rng.exponential(size=len(model.group))
        start /= np.bincount(model.group, start)[model.group]
        quadratic = layer_model.project(model, frame)
        objective = layer_objective.at(model, quadratic, quadratic, 0.2, 0.05, start)
        value, _ = layer_search.descend(model, objective, start)
        end = layer_published.sequential(model, objective, start)
        worse += value > layer_objective.value(model, objective, end) + 1e-6
    assert worse <= 1


def test_published_sequence_finds_planted_layers_or_stays_above():
    rng = np.random.default_rng(2)
    model = built(rng)
    weights = rng.dirichlet(np.full(3, 5.0), 3)
    coefficients = np.concatenate([rng.dirichlet(np.full(n, 5.0)) for n in (4, 3, 2)])
    frame = np.sum(model.masks.T * ((model.basis * coefficients) @ weights[:, LAYER].T), axis=1)
    frames = np.stack([frame, np.full(SIZE, np.nan), frame])
    settings = layer_solver.Settings(0.0)
    published = layer_published.solve(model, settings, frames, np.zeros(3), seed=1)
    own = layer_solver.solve(model, settings, frames, np.zeros(3))
    assert np.isnan(published.objective[1])
    assert np.all(published.objective[[0, 2]] >= own.objective[[0, 2]] - 1e-9)
    assert np.all(published.objective[[0, 2]] < 1e-3)
    assert np.all(published.bound[[0, 2]] == -np.inf)
    same = layer_published.solve(model, settings, frames, np.zeros(3), seed=1)
    np.testing.assert_array_equal(same.weights, published.weights)


def test_published_sequence_refuses_soft_bounds():
    model = built(np.random.default_rng(3))
    with pytest.raises(ValueError, match="beyond"):
        layer_published.solve(
            model, layer_solver.Settings(0.0, 0.5), np.zeros((1, SIZE)), np.zeros(1)
        )
