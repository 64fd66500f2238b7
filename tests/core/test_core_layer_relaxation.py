import hypothesis
import numpy as np
from hypothesis import strategies as st

from stages.core import layer_model, layer_objective, layer_relaxation, layer_solver, layer_starts

LAYER = np.repeat([0, 1, 2], (4, 3, 2))
SIZE = 40


def built(rng, regions):
    basis = rng.normal(size=(SIZE, len(LAYER))) / np.sqrt(SIZE)
    masks = rng.dirichlet(np.full(regions, 0.2), SIZE).T
    return layer_model.build(basis, LAYER, masks, 0, 1, 5)


@hypothesis.given(
    seed=st.integers(0, 2**32 - 1),
    closeness=st.sampled_from([0.0, 0.4, 1.0]),
    temporal=st.sampled_from([0.0, 0.3]),
    regions=st.integers(1, 3),
)
@hypothesis.settings(deadline=None, max_examples=60)
def test_bound_holds_everywhere(seed, closeness, temporal, regions):
    rng = np.random.default_rng(seed)
    model = built(rng, regions)
    points = layer_starts.draws(model, 30, seed)
    quadratic = layer_model.project(model, rng.normal(size=SIZE) / np.sqrt(SIZE))
    objective = layer_objective.at(model, quadratic, quadratic, closeness, temporal, points[1])
    share = rng.dirichlet(np.ones(regions), 3).T.ravel()
    start = np.full(len(model.first), 1 / len(LAYER))
    relaxed, bound = layer_relaxation.solve(model, objective, share, start)
    np.testing.assert_allclose(np.bincount(model.mask_group, relaxed), 1)
    values = [layer_objective.value(model, objective, point) for point in points]
    assert bound <= min(values) + 1e-12
    # where the last frame's pull is nil, the bound is the relaxation's own value to rounding
    if closeness == temporal == 0:
        assert bound >= layer_model.data(quadratic, relaxed) - 1e-6


def test_one_mask_leaves_no_gap():
    rng = np.random.default_rng(0)
    model = built(rng, 1)
    frames = rng.normal(size=(10, SIZE)) / np.sqrt(SIZE)
    found = layer_solver.solve(model, layer_solver.Settings(0.0), frames, np.zeros(10))
    np.testing.assert_allclose(found.objective, found.bound, atol=1e-7)


def test_factors_of_layers_are_found_again():
    rng = np.random.default_rng(1)
    model = built(rng, 3)
    point = layer_starts.draws(model, 1, 2)[1]
    u = point[model.first] * point[model.second]
    np.testing.assert_allclose(layer_relaxation.factors(model, u, np.zeros(9)), point)
    point[2:9:3] = 0.0
    point[:9] /= np.bincount(model.group[:9], point[:9])[model.group[:9]]
    u = point[model.first] * point[model.second]
    otherwise = rng.uniform(size=9)
    again = layer_relaxation.factors(model, u, otherwise)
    np.testing.assert_allclose(again[:16], point[:16])
    np.testing.assert_array_equal(again[16:], otherwise[7:])


def test_a_layer_without_weight_is_offered_its_best_extreme():
    rng = np.random.default_rng(2)
    model = built(rng, 3)
    coefficients = np.array([1.0, 0, 0, 0, 0, 1, 0, 1, 0])
    weights = np.tile([0.5, 0.5, 0.0], 3)
    point = np.concatenate([weights, coefficients])
    wanted = np.concatenate([np.tile([0.4, 0.4, 0.2], 3), coefficients])
    wanted[-2:] = [0.0, 1.0]
    u = (wanted[model.first] * wanted[model.second]).reshape(3, -1)
    frame = np.sum(model.masks * (u @ model.basis.T), axis=0)
    quadratic = layer_model.project(model, frame)
    objective = layer_objective.at(model, quadratic, quadratic, 0.0, 0.0, None)
    assert layer_starts.without_weight(model, point).tolist() == [2]
    revived = layer_starts.revived(model, objective, point)
    np.testing.assert_array_equal(revived[-2:], [0.0, 1.0])
    np.testing.assert_array_equal(revived[:-2], point[:-2])
