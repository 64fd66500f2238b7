import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import optimize

from stages.core import clip_least_squares, clip_window

SEEDS = st.integers(0, 10_000)


def problem(seed, frames=12, columns=4, rows=6, noise=0.3):
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(rows, columns)) + 0.5 * rng.normal(size=(rows, 1))
    weights = np.cumsum(0.4 * rng.normal(size=(frames, columns)), axis=0)
    targets = weights @ matrix.T + noise * rng.normal(size=(frames, rows))
    return matrix, targets, 10 ** rng.uniform(-2, 2, columns)


def stacked(matrix, targets, smooth, ridge):
    """Return the whole clip as one least-squares problem, rows that are missing left out."""
    frames, columns = len(targets), matrix.shape[1]
    bend = np.diff(np.eye(frames), 2, axis=0)
    blocks = [np.kron(np.eye(frames), matrix), np.sqrt(ridge) * np.eye(frames * columns)]
    blocks += [np.kron(bend, np.diag(np.sqrt(smooth)))]
    whole = np.vstack(blocks)
    right = np.concatenate([targets.ravel(), np.zeros(len(whole) - targets.size)])
    kept = np.isfinite(right)
    return whole[kept], right[kept]


def reference(matrix, targets, lower, upper, smooth, ridge):
    whole, right = stacked(matrix, targets, smooth, ridge)
    bounds = (np.tile(lower, len(targets)), np.tile(upper, len(targets)))
    best = optimize.lsq_linear(whole, right, bounds, method="bvls", tol=1e-14)
    return best.x.reshape(len(targets), -1)


@settings(deadline=None, max_examples=25)
@given(SEEDS, st.booleans(), st.integers(1, 14))
def test_clip_is_that_of_a_dense_solve(seed, gaps, frames):
    matrix, targets, smooth = problem(seed, frames)
    rng = np.random.default_rng(seed)
    if gaps:
        targets[rng.random(targets.shape) < 0.2] = np.nan
    lower, upper = np.full(4, -0.3), np.array([0.5, 0.8, 0.2, np.inf])
    expected = reference(matrix, targets, lower, np.minimum(upper, 1e6), smooth, 1e-3)
    found, residual = clip_least_squares.solve(
        matrix, targets, lower, upper, smooth, 1e-3, tolerance=1e-9
    )
    np.testing.assert_allclose(found, expected, atol=1e-5)
    assert residual.max() <= 1e-9


@pytest.mark.parametrize("strength", [0.0, 1.0, 4.0])
def test_windows_agree_with_the_whole_clip(strength, monkeypatch):
    matrix, targets, smooth = problem(1, frames=300)
    targets[40:44, :3] = np.nan
    arguments = (matrix, targets, np.zeros(4), np.ones(4), strength * smooth, 1e-6, 1e-6)
    monkeypatch.setattr(clip_least_squares, "_FRAMES", 300)
    whole, _ = clip_least_squares.solve(*arguments)
    monkeypatch.setattr(clip_least_squares, "_FRAMES", 80)
    monkeypatch.setattr(clip_least_squares, "_STEP", 60)
    parts, residual = clip_least_squares.solve(*arguments)
    np.testing.assert_allclose(parts, whole, atol=1e-4)
    assert residual.max() <= 1e-6


def test_single_frames_are_those_of_a_bounded_solve():
    matrix, targets, smooth = problem(2, frames=400, rows=12)
    targets[::7, 2:4] = np.nan
    found, residual = clip_least_squares.solve(
        matrix, targets, np.zeros(4), np.ones(4), 0 * smooth, 0.0, 1e-9
    )
    for row, target in zip(found[::29], targets[::29], strict=True):
        seen = np.isfinite(target)
        best = optimize.lsq_linear(matrix[seen], target[seen], (0, 1), method="bvls", tol=1e-14)
        np.testing.assert_allclose(row, best.x, atol=1e-6)
    assert residual.max() <= 1e-9


def test_constant_and_even_motion_are_not_changed_by_any_strength():
    matrix, _, _ = problem(3)
    even = np.linspace([0.1, 0.9, 0.5, 0.3], [0.8, 0.2, 0.5, 0.4], 50)
    found, _ = clip_least_squares.solve(
        matrix, even @ matrix.T, np.zeros(4), np.ones(4), np.full(4, 1e3), 0.0, 1e-9
    )
    np.testing.assert_allclose(found, even, atol=1e-6)


@settings(deadline=None, max_examples=10)
@given(SEEDS)
def test_time_runs_either_way(seed):
    matrix, targets, smooth = problem(seed, frames=30)
    arguments = (np.zeros(4), np.ones(4), smooth, 1e-3, 1e-9)
    forward, _ = clip_least_squares.solve(matrix, targets, *arguments)
    backward, _ = clip_least_squares.solve(matrix, targets[::-1], *arguments)
    np.testing.assert_allclose(backward[::-1], forward, atol=1e-6)


@given(SEEDS)
def test_residual_is_zero_only_at_the_minimum(seed):
    matrix, targets, smooth = problem(seed)
    given_ = clip_window.problem(matrix, 0.0, smooth, np.full(4, -9.0), np.full(4, 9.0))
    none = np.zeros((0, 4))
    window = clip_window.Window(targets @ matrix, targets @ matrix, None, none, none)
    whole, right = stacked(matrix, targets, smooth, 0.0)
    best = np.linalg.lstsq(whole, right, rcond=None)[0].reshape(12, 4)
    np.testing.assert_allclose(clip_window.gradient(given_, window, best), 0, atol=1e-8)
    if np.abs(best).max() < 8:
        moved = best.copy()
        moved[5, 2] += 0.25
        # the weight that was moved wants back by as much
        assert clip_window.kkt_residual(given_, window, best).max() < 1e-8
        assert clip_window.kkt_residual(given_, window, moved)[5] >= 0.25 - 1e-8


def test_what_does_not_fit_is_refused():
    matrix, targets, smooth = problem(0)
    zero, one = np.zeros(4), np.ones(4)
    for arguments, message in (
        ((matrix, targets[:, 1:], zero, one, smooth), "do not fit the matrix"),
        ((matrix, targets, zero, one[1:], smooth), "do not fit"),
        ((matrix, targets, one, zero, smooth), "above their upper"),
        ((matrix, targets, zero, one, -smooth), "negative"),
    ):
        with pytest.raises(ValueError, match=message):
            clip_least_squares.solve(*arguments)
