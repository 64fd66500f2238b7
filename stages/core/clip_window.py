"""Bounded weights of a run of frames that are smooth in time, by splitting (ADMM).

Data and smoothness are solved exactly in the eigenvectors of both, the bounds by clipping; the two
are brought together by multipliers, under step sizes that take turns.
"""

from typing import NamedTuple

import numpy as np

# step sizes as shares of the usual curvature of the data term, and how long each has its turn
_STEPS = (0.01, 0.1, 1.0, 10.0)
_TURN = 10
_RELAXATION = 1.8
_ROUNDS = 10
# of the inner solve on frames with points that were not observed
_INNER, _INNER_STEPS = 0.1, 40


class Problem(NamedTuple):
    """Hold what all windows of a clip share.

    Attributes
    ----------
    matrix : (D, K) float array
    gram : (K, K) float array
        ``A'A`` with the ridge on its diagonal, positive definite.
    smooth : (K,) float array
        Weight of the squared second differences of each channel.
    lower, upper : (K,) float array
    steps : tuple of Step
    """

    matrix: np.ndarray
    gram: np.ndarray
    smooth: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    steps: tuple


class Step(NamedTuple):
    """Hold a step size (K,) and the modes in which it makes the linear system diagonal.

    ``V' (G + diag(rho)) V = I`` and ``V' diag(smooth) V = diag(share)``; the inverse is that of
    ``G + diag(rho)``.
    """

    rho: np.ndarray
    V: np.ndarray
    share: np.ndarray
    inverse: np.ndarray


class Frames(NamedTuple):
    """Hold ``D'D`` (n, n) of a run of frames, its eigenvalues (n,) and eigenvectors (n, n)."""

    bends: np.ndarray
    values: np.ndarray
    vectors: np.ndarray


class Window(NamedTuple):
    """Hold a run of n frames.

    Attributes
    ----------
    right : (n, K) float array
        Observed targets times the matrix.
    guess : (n, K) float array
        The same with a guess of what was not observed, for the start.
    seen : (n, D) bool array or None
        None where every coordinate of every frame was observed.
    before, after : (0 or 2, K) float array
        Weights of the neighbouring frames, which are held; none where the window ends freely.
    """

    right: np.ndarray
    guess: np.ndarray
    seen: np.ndarray | None
    before: np.ndarray
    after: np.ndarray


def problem(matrix, ridge, smooth, lower, upper):
    """Return what all windows share, with the eigenvectors for every step size.

    Raises
    ------
    ValueError
        When a lower limit is above its upper one.
    """
    if (lower > upper).any():
        raise ValueError(f"{np.count_nonzero(lower > upper)} lower limits are above their upper")
    gram = matrix.T @ matrix + ridge * np.eye(matrix.shape[1])
    usual = np.sqrt(gram.diagonal() * gram.diagonal().mean())
    steps = tuple(_step(gram, smooth, share * usual) for share in _STEPS)
    return Problem(matrix, gram, smooth, lower, upper, steps)


def _step(gram, smooth, rho):
    """Solve the eigenproblem of one step size."""
    root = np.linalg.inv(np.linalg.cholesky(gram + np.diag(rho)))
    if not smooth.any():
        return Step(rho, root.T, np.zeros_like(rho), root.T @ root)
    share, Q = np.linalg.eigh((root * smooth) @ root.T)
    return Step(rho, root.T @ Q, np.maximum(share, 0.0), root.T @ root)


def second_differences(before, weights, after):
    """Return ``D'D w`` of a run of frames (n, K), D taking second differences.

    Differences that reach into the frames before and after count, others beyond the run do not.
    """
    whole = np.concatenate([before, weights, after])
    if len(whole) < 3:
        return np.zeros_like(weights)
    bent = np.zeros((len(whole) + 2, whole.shape[1]))
    bent[2:-2] = whole[2:] - 2 * whole[1:-1] + whole[:-2]
    pulled = bent[2:] - 2 * bent[1:-1] + bent[:-2]
    return pulled[len(before) : len(before) + len(weights)]


def _times(frames, before, after):
    """Return ``D'D`` of a run of frames and its eigenvectors."""
    sides = [np.zeros((len(side), frames)) for side in (before, after)]
    bends = second_differences(sides[0], np.eye(frames), sides[1])
    values, vectors = np.linalg.eigh(bends)
    return Frames(bends, np.maximum(values, 0.0), vectors)


def gradient(given, window, weights):
    """Return the gradient (n, K) of half the objective."""
    slope = weights @ given.gram - window.right
    if window.seen is not None:
        slope -= _unseen(given, window.seen, weights)
    return slope + given.smooth * second_differences(window.before, weights, window.after)


def kkt_residual(given, window, weights):
    """Return how far every frame's weights are from the optimality conditions.

    ``max_k |w_k - clip(w_k - g_k / h_k, lower_k, upper_k)|`` with g the gradient and h the second
    derivative where everything was observed: the largest change that one weight would make if it
    alone were free. No unit.

    Returns
    -------
    (n,) float array
    """
    length = _own(len(weights), window)[:, None] * given.smooth + given.gram.diagonal()
    wanted = weights - gradient(given, window, weights) / length
    return np.abs(weights - np.clip(wanted, given.lower, given.upper)).max(axis=1, initial=0.0)


def solve(given, window, tolerance, start=None):
    """Minimise over the frames of a window, those around it being held.

    ``sum_t |A w_t - x_t|^2 + ridge |w_t|^2 + sum_k smooth_k sum_t (w_t-1 - 2 w_t + w_t+1)_k^2``
    subject to ``lower <= w_t <= upper``.

    Parameters
    ----------
    given : Problem
    window : Window
    tolerance : float
        Of the KKT residual.
    start : (n, K) float array or None
        Weights within the bounds that are near the answer.

    Returns
    -------
    (n, K) float array

    Notes
    -----
    Boyd, Parikh, Chu, Peleato & Eckstein 2011. Step sizes that differ by powers of ten serve fast
    and slow motion by turns; the turns grow longer, so that in the end one step size rules.
    """
    frames = _times(len(window.right), window.before, window.after) if given.smooth.any() else None
    still = np.zeros_like(window.right)
    held = given.smooth * second_differences(window.before, still, window.after)
    if start is None:
        start = _stepped(given.steps[0], frames, window.guess - held)
        start = np.clip(start, given.lower, given.upper)
    return _iterated(given, window, window.right - held, frames, start, tolerance)


def _iterated(given, window, right, frames, weights, tolerance):
    """Return the weights (n, K) that steps and clips by turns lead to from a start.

    Where nothing joins frames to one another, all observed alike, each leaves when it is done.
    """
    answer, rows = weights.copy(), np.arange(len(weights))
    free, multiplier = weights, -gradient(given, window, weights)
    for turn in range(_ROUNDS * len(given.steps)):
        residual = kkt_residual(given, window, weights)
        answer[rows] = weights
        if residual.max(initial=0.0) <= tolerance:
            break
        if frames is None:
            left = residual > tolerance
            rows, weights, free = rows[left], weights[left], free[left]
            right, multiplier = right[left], multiplier[left]
            window = window._replace(right=window.right[left])
        step = given.steps[turn % len(given.steps)]
        for _ in range(_TURN * (1 + turn // (2 * len(given.steps)))):
            goal = right + step.rho * weights - multiplier
            free = _free(given, window.seen, step, frames, goal, free)
            mixed = _RELAXATION * free + (1 - _RELAXATION) * weights
            weights = np.clip(mixed + multiplier / step.rho, given.lower, given.upper)
            multiplier = multiplier + step.rho * (mixed - weights)
    return answer


def _free(given, seen, step, frames, goal, start):
    """Solve ``(H + diag(rho)) w = goal`` without bounds, H being the second derivatives.

    Exact where everything was observed; else by conjugate gradients, for which the solution with
    everything observed is the preconditioner.
    """
    if seen is None:
        return _stepped(step, frames, goal)

    def curved(weights):
        """Return ``(H + diag(rho)) w``."""
        product = weights @ given.gram - _unseen(given, seen, weights)
        return product + step.rho * weights + given.smooth * (frames.bends @ weights)

    weights, rest = start, goal - curved(start)
    enough = _INNER * np.linalg.norm(rest)
    along, size = np.zeros_like(start), 1.0
    for _ in range(_INNER_STEPS):
        if np.linalg.norm(rest) <= enough:
            break
        ahead = _stepped(step, frames, rest)
        before, size = size, np.sum(rest * ahead)
        along = ahead + (size / before) * along
        product = curved(along)
        share = size / np.sum(along * product)
        weights = weights + share * along
        rest = rest - share * product
    return weights


def _stepped(step, frames, goal):
    """Solve ``(H + diag(rho)) w = goal`` where everything was observed."""
    if frames is None:
        return goal @ step.inverse
    modes = (frames.vectors.T @ goal) @ step.V / (1 + frames.values[:, None] * step.share)
    return frames.vectors @ (modes @ step.V.T)


def _unseen(given, seen, weights):
    """Return what the coordinates that were not observed would add to the gradient."""
    rows = ~seen.all(axis=1)
    added = np.zeros_like(weights)
    added[rows] = np.where(seen[rows], 0.0, weights[rows] @ given.matrix.T) @ given.matrix
    return added


def _own(frames, window):
    """Return the diagonal (n,) of ``D'D``."""
    held = len(window.before)
    whole = held + frames + len(window.after)
    if whole < 3:
        return np.zeros(frames)
    return np.convolve(np.ones(whole - 2), [1.0, 4.0, 1.0])[held : held + frames]
