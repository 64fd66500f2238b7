import numpy as np
import pytest

from stages.core import box_least_squares, frame_least_squares


def problem(seed, shapes, rows, frames=300):
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(rows, shapes)) * rng.uniform(0.2, 2, shapes)
    weights = rng.uniform(-0.3, 1.3, (frames, shapes))
    return matrix, weights @ matrix.T + 0.2 * rng.normal(size=(frames, rows))


@pytest.mark.parametrize(("shapes", "rows"), [(5, 20), (46, 60), (60, 30)])
@pytest.mark.parametrize("upper", [1.0, np.inf])
def test_frames_are_those_of_exact_exchanges(shapes, rows, upper):
    matrix, targets = problem(0, shapes, rows)
    ridge = 1e-2 * np.mean(np.sum(matrix**2, axis=0))
    limits = np.zeros(shapes), np.full(shapes, upper)
    found, residual = frame_least_squares.solve(matrix, targets, *limits, ridge)
    gram = matrix.T @ matrix + ridge * np.eye(shapes)
    expected = [
        box_least_squares.solve_gram(gram, target @ matrix, *limits, np.zeros(shapes))
        for target in targets
    ]
    np.testing.assert_allclose(found, expected, atol=1e-4)
    assert residual.max() <= 1e-6


def test_shapes_that_are_alike_or_unseen_come_to_an_end():
    matrix, targets = problem(1, 12, 30)
    matrix[:, 3] = 0.0
    matrix[:, 5] = matrix[:, 4] + 1e-5 * matrix[:, 6]
    limits = np.zeros(12), np.ones(12)
    ridge = 1e-6 * np.mean(np.sum(matrix**2, axis=0))
    found, residual = frame_least_squares.solve(matrix, targets, *limits, ridge)
    assert residual.max() <= 1e-6
    np.testing.assert_allclose(found[:, 3], 0, atol=1e-9)


def test_every_pattern_of_points_is_solved_on_its_own():
    matrix, targets = problem(2, 4, 12, frames=40)
    limits = np.zeros(4), np.ones(4)
    targets[::2, :3] = np.nan
    targets[5, 6:] = np.nan
    found, residual = frame_least_squares.solve(matrix, targets, *limits)
    for row, target in zip(found, targets, strict=True):
        seen = np.isfinite(target)
        expected = box_least_squares.solve(matrix[seen], target[None, seen], *limits)
        np.testing.assert_allclose(row, expected[0], atol=1e-5)
    assert residual.max() <= 1e-6
