"""Exact least squares under bounds, many right-hand sides against one matrix."""

import numpy as np

# Makes the minimiser unique when columns depend on one another; below what anyone can measure.
_TIE_BREAK = 1e-13
_OPTIMAL = 1e-11
_PATIENCE = 3


def reduce(matrix, targets):
    """Shrink a problem to as many rows as columns, by one QR factorisation.

    ``|A w - x|^2 = |R w - z|^2 + rest^2`` for every w.

    Parameters
    ----------
    matrix : (D, K) float array
    targets : (T, D) float array

    Returns
    -------
    R : (min(D, K), K) float array
    z : (T, min(D, K)) float array
    rest : (T,) float array
        Distance of every target from the span of the matrix.
    """
    Q, R = np.linalg.qr(matrix)
    z = targets @ Q
    return R, z, np.linalg.norm(targets - z @ Q.T, axis=1)


def solve(matrix, targets, lower, upper):
    """Minimise ``|A w_t - x_t|^2`` subject to ``lower <= w_t <= upper`` for every frame t.

    Each frame starts from the active set of the frame before it, which for a film is nearly
    always within a few exchanges of the answer.

    Parameters
    ----------
    matrix : (D, K) float array
    targets : (T, D) float array
    lower, upper : (K,) float array
        Infinities stand for no bound.

    Returns
    -------
    (T, K) float array

    Raises
    ------
    ValueError
        When the shapes do not fit, or a lower bound is above its upper bound.
    """
    matrix, targets = np.asarray(matrix, float), np.asarray(targets, float)
    lower, upper = np.asarray(lower, float), np.asarray(upper, float)
    if targets.ndim != 2 or targets.shape[1] != len(matrix):
        raise ValueError(f"targets {targets.shape} do not fit the matrix {matrix.shape}")
    if lower.shape != upper.shape or lower.shape != matrix.shape[1:] or (lower > upper).any():
        raise ValueError(f"bounds {lower.shape}, {upper.shape} do not fit {matrix.shape}")
    R, z, _ = reduce(matrix, targets)
    gram, right = R.T @ R, z @ R
    start = np.clip(np.zeros(len(lower)), lower, upper)
    weights = np.empty((len(targets), len(lower)))
    for t, linear in enumerate(right):
        weights[t] = start = solve_gram(gram, linear, lower, upper, start)
    return weights


def solve_gram(gram, linear, lower, upper, start):
    """Minimise ``w' G w / 2 - b' w`` subject to ``lower <= w <= upper``.

    Whole sets of weights change sides at once while that makes fewer of them wrong (block
    pivoting); should it cycle, a primal active-set method finishes, which cannot.

    Parameters
    ----------
    gram : (K, K) float array
        Positive semi-definite.
    linear : (K,) float array
    lower, upper : (K,) float array
    start : (K,) float array
        Feasible weights; those strictly inside their bounds are the first guess of the
        weights that are free at the minimum.

    Returns
    -------
    (K,) float array

    Notes
    -----
    Judice & Pires 1994; Lawson & Hanson 1974.
    """
    diagonal = gram.diagonal()
    size = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    gram = gram + np.diag(np.where(diagonal > 0, _TIE_BREAK * diagonal, 1.0))
    side = (start >= upper).astype(int) - (start <= lower)
    fewest, patience = len(linear) + 1, _PATIENCE
    while True:
        weights = _minimum_on(gram, linear, lower, upper, side)
        slope = (gram @ weights - linear) / size
        enough = _tolerance(linear, size, weights)
        new = side.copy()
        new[(side == 0) & ((weights - lower) * size < -enough)] = -1
        new[(side == 0) & ((weights - upper) * size > enough)] = 1
        new[((side < 0) & (slope < -enough)) | ((side > 0) & (slope > enough))] = 0
        wrong = np.count_nonzero((new != side) & (lower < upper))
        if not wrong:
            return np.clip(weights, lower, upper)
        if wrong < fewest:
            fewest, patience = wrong, _PATIENCE
        elif patience == 0:
            return _active_set(gram, linear, lower, upper, np.clip(weights, lower, upper))
        else:
            patience -= 1
        side = np.where(lower < upper, new, side)


def _tolerance(linear, size, weights):
    """Return the slope, per unit of a column's length, that counts as rounding."""
    scale = max(np.abs(linear / size).max(), np.abs(size * weights).max())
    return _OPTIMAL * scale


def _minimum_on(gram, linear, lower, upper, side):
    """Return the minimum when weights with side -1 and 1 stay on their bounds."""
    weights = np.where(side < 0, lower, np.where(side > 0, upper, 0.0))
    free = np.flatnonzero(side == 0)
    if len(free):
        right = linear[free] - gram[free] @ weights
        weights[free] = np.linalg.solve(gram[np.ix_(free, free)], right)
    return weights


def _active_set(gram, linear, lower, upper, weights):
    """Minimise by releasing one weight at a time, staying within the bounds throughout."""
    size = np.sqrt(gram.diagonal())
    side = (weights >= upper).astype(int) - (weights <= lower)
    for _ in range(20 * len(weights)):
        goal = _minimum_on(gram, linear, lower, upper, side)
        out = (goal < lower) | (goal > upper)
        if out.any():
            bound = np.where(goal < lower, lower, upper)
            span = np.where(out, goal - weights, 1.0)
            share = np.where(out, (bound - weights) / span, np.inf)
            first = share.argmin()
            weights = np.clip(weights + share[first] * (goal - weights), lower, upper)
            weights[first] = bound[first]
            side[first] = np.sign(goal[first] - bound[first])
            continue
        weights = goal
        pull = -side * (gram @ weights - linear) / size
        pull[lower >= upper] = 0.0
        if pull.min() >= -_tolerance(linear, size, weights):
            break
        side[pull.argmin()] = 0
    return weights


def kkt_residual(matrix, targets, lower, upper, weights):
    """Return how far every frame's weights are from satisfying the optimality conditions.

    ``max_i |w_i - clip(w_i - g_i / |a_i|^2, lower_i, upper_i)|`` with g the gradient: the
    largest change that one weight would make if it alone were free. No unit, 0 at the minimum.

    Parameters
    ----------
    matrix : (D, K) float array
    targets : (T, D) float array
    lower, upper : (K,) float array
    weights : (T, K) float array

    Returns
    -------
    (T,) float array
    """
    length = np.maximum(np.sum(matrix**2, axis=0), np.finfo(float).tiny)
    step = (weights @ matrix.T - targets) @ matrix / length
    return np.abs(weights - np.clip(weights - step, lower, upper)).max(axis=1)
