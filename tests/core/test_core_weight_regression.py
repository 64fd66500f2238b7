import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import (
    pair_contradictions,
    partial_projection,
    pca,
    rbf,
    regression_choice,
    weight_regression,
)
from stages.core.weight_regression import Form

FORMS = {
    "rbf": Form(0, 3, 2.0),
    "linear": Form(4, 0, 1.0),
    "rbf_linear": Form(4, 2, 2.0, 0.1, 0.01),
}


def drawn(seed, rows=40, noise=0.02):
    """Return coordinates of falling size, and weights that are linear in them but for one."""
    rng = np.random.default_rng(seed)
    coordinates = rng.normal(size=(rows, 5)) * [4, 3, 2, 1, 0.5]
    mix = rng.normal(size=(5, 3)) / [[4], [3], [2], [1], [0.5]]
    targets = 0.1 * coordinates @ mix
    targets[:, 2] += 0.2 * np.cos(coordinates[:, 0] / 3)
    return coordinates, targets + noise * rng.normal(size=targets.shape)


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
def test_leaving_one_out_agrees_with_explicit_refits(form):
    coordinates, targets = drawn(1, rows=18)
    trained, residuals = weight_regression.train(coordinates, targets, form)
    parts = weight_regression.decompose(coordinates, form)
    if form.linear_dimensions and form.rbf_dimensions:
        design = parts.left * parts.singular
    else:
        design = parts.design
    for row in range(18):
        rest = np.delete(np.arange(18), row)
        for column in np.flatnonzero(trained.lambdas > 1e-6):
            value = trained.lambdas[column]
            lifted = np.hstack([parts.free, design])
            cost = np.diag(np.r_[np.zeros(parts.free.shape[1]), np.full(design.shape[1], value)])
            system = lifted[rest].T @ lifted[rest] + cost
            own = np.linalg.solve(system, lifted[rest].T @ targets[rest, column])
            expected = targets[row, column] - lifted[row] @ own
            assert residuals[row, column] == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("method", weight_regression.METHODS)
def test_a_planted_map_is_recovered(method):
    coordinates, targets = drawn(2, rows=150, noise=0.0)
    form = regression_choice.choose(coordinates[:110], targets[:110], method)
    trained, _ = weight_regression.train(coordinates[:110], targets[:110], form)
    wrong = weight_regression.predict(trained, coordinates[110:]) - targets[110:]
    spread = targets.std(axis=0)
    assert np.abs(wrong[:, :2]).mean() < 0.1 * spread[0]
    if method == "linear":
        assert np.abs(wrong[:, :2]).max() < 1e-6
    else:
        assert np.abs(wrong[:, 2]).mean() < 0.35 * 0.2


def test_a_gaussian_part_costs_nothing_where_a_line_is_right():
    coordinates, targets = drawn(3, rows=130)
    wrong = {}
    for method in ("linear", "rbf_linear"):
        form = regression_choice.choose(coordinates[:60], targets[:60, :2], method)
        trained, _ = weight_regression.train(coordinates[:60], targets[:60, :2], form)
        found = weight_regression.predict(trained, coordinates[60:])
        wrong[method] = np.abs(found - targets[60:, :2]).mean()
    assert wrong["rbf_linear"] < 1.05 * wrong["linear"]


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 10_000), st.sampled_from(list(FORMS)))
def test_the_order_of_pairs_and_of_shapes_does_not_matter(seed, name):
    coordinates, targets = drawn(seed)
    order = np.random.default_rng(seed).permutation(len(targets))
    trained, residuals = weight_regression.train(coordinates, targets, FORMS[name])
    again, turned = weight_regression.train(
        coordinates[order], targets[order][:, ::-1], FORMS[name]
    )
    np.testing.assert_allclose(turned[:, ::-1], residuals[order], rtol=1e-4, atol=1e-5)
    there = weight_regression.predict(trained, coordinates * 1.1)
    back = weight_regression.predict(again, coordinates * 1.1)
    np.testing.assert_allclose(back[:, ::-1], there, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("method", weight_regression.METHODS)
def test_the_unit_of_the_points_does_not_matter(method):
    coordinates, targets = drawn(4)
    found = []
    for scale in (1.0, 1000.0):
        form = regression_choice.choose(scale * coordinates, targets, method)
        trained, _ = weight_regression.train(scale * coordinates, targets, form)
        found.append(weight_regression.predict(trained, scale * coordinates))
    np.testing.assert_allclose(found[0], found[1], atol=1e-5)


@pytest.mark.parametrize("method", weight_regression.METHODS)
def test_a_planted_contradiction_stands_out_and_its_neighbour_is_blamed(method):
    coordinates, targets = drawn(5, rows=60)
    coordinates = np.vstack([coordinates, coordinates[7] + 0.01])
    targets = np.vstack([targets, targets[7] + [0.5, -0.5, 0.5]])
    form = regression_choice.choose(coordinates, targets, method)
    trained, residuals = weight_regression.train(coordinates, targets, form)
    misfits = targets - weight_regression.predict(trained, coordinates)
    doubt = pair_contradictions.doubt(residuals, misfits)
    assert doubt.argmax() == 60
    assert pair_contradictions.partners(coordinates, targets)[[7, 60]].tolist() == [60, 7]


def test_partners_of_equal_and_of_distant_pairs_exist():
    coordinates = np.array([[0.0], [0.0], [1e6], [2e6]])
    partners = pair_contradictions.partners(coordinates, np.zeros((4, 2)))
    assert all(partner != row for row, partner in enumerate(partners))
    with pytest.raises(ValueError, match="two pairs"):
        pair_contradictions.partners(np.zeros((1, 2)), np.zeros((1, 2)))


def test_doubled_places_do_not_make_widths_vanish():
    places = np.repeat(np.array([[0.0], [2.0], [5.0]]), 2, axis=0)
    assert rbf.nearest_distance(places) == pytest.approx(2.0)
    assert rbf.nearest_distance(np.zeros((4, 2))) == 1.0
    trained, _ = weight_regression.train(places, np.arange(12.0).reshape(6, 2), Form(0, 1, 2.0))
    assert np.isfinite(trained.weights).all()


@pytest.mark.parametrize("method", weight_regression.METHODS)
def test_few_examples_limit_the_dimensions(method):
    coordinates, targets = drawn(6, rows=4)
    form = regression_choice.choose(coordinates, targets, method)
    assert max(form.linear_dimensions, form.rbf_dimensions) <= 2
    with pytest.raises(ValueError, match="too few for 5 dimensions"):
        regression_choice.choose(coordinates, targets, method, 5)
    with pytest.raises(ValueError, match="too few for a regression"):
        regression_choice.choose(coordinates[:2], targets[:2], method)
    with pytest.raises(ValueError, match="unknown method"):
        regression_choice.choose(coordinates, targets, "spline")


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 10_000))
def test_missing_values_are_filled_by_the_axes(seed):
    rng = np.random.default_rng(seed)
    scores = rng.normal(size=(200, 3)) * [5, 3, 2]
    frames = 7 + scores @ np.linalg.qr(rng.normal(size=(30, 3)))[0].T
    frames = frames + 1e-3 * rng.normal(size=frames.shape)
    model, noise = partial_projection.truncate(pca.fit(frames), 3)
    assert noise == pytest.approx(1e-6, rel=0.3)
    whole = pca.project(model, frames)
    np.testing.assert_array_equal(partial_projection.project(model, noise, frames), whole)
    holes = frames.copy()
    holes[rng.random(frames.shape) < 0.2] = np.nan
    holes[3] = np.nan
    found = partial_projection.project(model, noise, holes)
    np.testing.assert_allclose(found[3], 0, atol=1e-9)
    np.testing.assert_allclose(np.delete(found, 3, 0), np.delete(whole, 3, 0), atol=0.05)
    # one frame by the formula as it stands
    seen = np.isfinite(holes[0])
    part = model.components[:, seen]
    system = part @ part.T / noise + np.diag(1 / model.variance)
    likeliest = np.linalg.solve(system, part @ (holes[0] - model.mean)[seen] / noise)
    filled = np.where(seen, holes[0], model.mean + likeliest @ model.components)
    np.testing.assert_allclose(found[0], pca.project(model, filled[None])[0], atol=1e-6)


def test_frames_of_other_points_are_refused():
    model = pca.fit(np.random.default_rng(0).normal(size=(9, 4)))
    with pytest.raises(ValueError, match=r"\(2, 3\) for axes of 4"):
        partial_projection.project(model, 1.0, np.zeros((2, 3)))
