import numpy as np
import pytest
from scipy import optimize

from stages.core import local_shapes, mesh_projection

VERTICES = 600  # more than one block


def shapes(rng, count, reach=80):
    """Draw shapes that each move a run of vertices."""
    deltas = np.zeros((count, VERTICES, 3))
    for delta in deltas:
        start = rng.integers(0, VERTICES - reach)
        delta[start : start + reach] = rng.normal(size=(reach, 3))
    return deltas


@pytest.mark.parametrize("count", [6, 45])
def test_it_is_the_bounded_least_squares_fit_of_all_vertices(count):
    rng = np.random.default_rng(count)
    own, other = shapes(rng, 9), shapes(rng, count, 200)
    weights = rng.uniform(-0.5, 1.5, size=(4, 9))
    lower, upper = np.full(count, 0.0), rng.uniform(0.2, 1.0, count)
    given = mesh_projection.products(local_shapes.gather(own), local_shapes.gather(other))
    found, residual = mesh_projection.project(given, weights, lower, upper)
    matrix = other.reshape(count, -1).T
    moved = (own.any(axis=(0, 2)) | other.any(axis=(0, 2))).sum()
    assert given.moved == moved
    for frame, wanted, rest in zip(weights, found, residual, strict=True):
        target = np.tensordot(frame, own, axes=1).ravel()
        best = optimize.lsq_linear(matrix, target, (lower, upper), method="bvls", tol=1e-15)
        np.testing.assert_allclose(wanted, best.x, atol=1e-8)
        away = np.linalg.norm(matrix @ best.x - target)
        np.testing.assert_allclose(rest, away / np.sqrt(moved), rtol=1e-9)


def test_what_the_other_rig_can_do_comes_back_and_leaves_nothing():
    rng = np.random.default_rng(0)
    other = shapes(rng, 12)
    mix = rng.uniform(0, 0.3, size=(5, 12))
    own = local_shapes.gather(np.tensordot(mix, other, axes=1))
    weights = rng.dirichlet(np.ones(5), 30)
    given = mesh_projection.products(own, local_shapes.gather(other))
    found, residual = mesh_projection.project(given, weights, np.zeros(12), np.ones(12))
    np.testing.assert_allclose(found, weights @ mix, atol=1e-9)
    assert residual.max() < 1e-7


def test_shapes_that_move_nothing_stay_at_zero_and_still_faces_are_exact():
    rng = np.random.default_rng(1)
    other = shapes(rng, 3)
    other[1] = 0.0
    still = local_shapes.gather(np.zeros((2, VERTICES, 3)))
    given = mesh_projection.products(still, local_shapes.gather(other))
    found, residual = mesh_projection.project(given, np.ones((2, 2)), np.zeros(3), np.ones(3))
    assert not found.any()
    assert not residual.any()
    with pytest.raises(ValueError, match="shapes of 600 and of 4 vertices"):
        mesh_projection.products(still, local_shapes.gather(np.ones((1, 4, 3))))
