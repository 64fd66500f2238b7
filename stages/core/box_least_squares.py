"""Exact least squares under bounds, many right-hand sides against one matrix."""

import numpy as np

# Makes the minimiser unique when columns depend on one another; below what anyone can measure.
_TIE_BREAK = 1e-13
_OPTIMAL = 1e-11
_PATIENCE = 3
_ROUNDS = 80
# up to here all frames together are faster than one after another
_FEW = 40


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
    if np.isneginf(lower).all() and np.isposinf(upper).all():
        return np.linalg.lstsq(R, z.T, rcond=None)[0].T
    return solve_gram_frames(R.T @ R, z @ R, lower, upper)


def solve_gram_frames(gram, linear, lower, upper):
    """Minimise ``w_t' G w_t / 2 - b_t' w_t`` subject to ``lower <= w_t <= upper`` for all frames.

    With few columns all frames are solved together. With many, each frame starts from the
    active set of the frame before it, which for a film is within a few exchanges of the answer.

    Parameters
    ----------
    gram : (K, K) float array
        Positive semi-definite.
    linear : (T, K) float array
    lower, upper : (K,) float array

    Returns
    -------
    (T, K) float array
    """
    weights = np.full(linear.shape, np.nan)
    if len(lower) <= _FEW:
        weights = _solve_together(gram, linear, lower, upper)
    start = np.clip(np.zeros(len(lower)), lower, upper)
    for t in np.flatnonzero(np.isnan(weights).any(axis=1)):
        weights[t] = start = solve_gram(gram, linear[t], lower, upper, start)
    return weights


def _solve_together(gram, right, lower, upper):
    """Return the minima (T, K) that block pivoting finds for all frames at once, NaN elsewhere.

    A frame on which whole exchanges stop helping exchanges its last wrong weight alone.
    """
    gram, size = _unique(gram)
    start = _sides(np.clip(np.zeros(len(lower)), lower, upper), lower, upper)
    side = np.tile(start, (len(right), 1))
    weights = np.full(right.shape, np.nan)
    fewest, patience = np.full(len(right), len(lower) + 1), np.zeros(len(right), int)
    left = np.arange(len(right))
    for _ in range(_ROUNDS):
        now = _minima_on(gram, right[left], lower, upper, side[left])
        new = _exchanged(gram, size, right[left], lower, upper, side[left], now)
        changed = new != side[left]
        wrong = np.count_nonzero(changed, axis=1)
        weights[left[wrong == 0]] = np.clip(now[wrong == 0], lower, upper)
        better = wrong < fewest[left]
        fewest[left] = np.minimum(fewest[left], wrong)
        patience[left] = np.where(better, _PATIENCE, patience[left] - 1)
        later = np.cumsum(changed[:, ::-1], axis=1)[:, ::-1]
        whole = (patience[left] >= 0)[:, None]
        side[left] = np.where(whole | (later == 1), new, side[left])
        left = left[wrong > 0]
        if not len(left):
            break
    return weights


def _minima_on(gram, right, lower, upper, side):
    """Return the minima (T, K) when weights with side -1 and 1 stay on their bounds."""
    fixed = np.where(side < 0, lower, np.where(side > 0, upper, 0.0))
    free = side == 0
    system = np.where(free[:, :, None] & free[:, None, :], gram, 0.0)
    system[:, range(len(gram)), range(len(gram))] += ~free
    value = np.where(free, right - fixed @ gram, fixed)
    return np.linalg.solve(system, value[:, :, None])[:, :, 0]


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
    gram, size = _unique(gram)
    side = _sides(start, lower, upper)
    fewest, patience = len(linear) + 1, _PATIENCE
    while True:
        weights = _minimum_on(gram, linear, lower, upper, side)
        new = _exchanged(gram, size, linear, lower, upper, side, weights)
        wrong = np.count_nonzero(new != side)
        if not wrong:
            return np.clip(weights, lower, upper)
        if wrong < fewest:
            fewest, patience = wrong, _PATIENCE
        elif patience == 0:
            return _active_set(gram, linear, lower, upper, np.clip(weights, lower, upper))
        else:
            patience -= 1
        side = new


def _unique(gram):
    """Return a positive definite matrix next to `gram`, and the lengths (K,) of the columns."""
    diagonal = gram.diagonal()
    size = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    return gram + np.diag(np.where(diagonal > 0, _TIE_BREAK * diagonal, 1.0)), size


def _sides(weights, lower, upper):
    """Return -1 for weights on their lower bound, 1 on the upper one, 0 between."""
    return np.where(weights <= lower, -1, np.where(weights >= upper, 1, 0))


def _exchanged(gram, size, linear, lower, upper, side, weights):
    """Return the sides (..., K) after every weight that stands wrong has changed its own."""
    slope = (weights @ gram - linear) / size
    enough = _tolerance(linear, size, weights)
    new = side.copy()
    new[(side == 0) & ((weights - lower) * size < -enough)] = -1
    new[(side == 0) & ((weights - upper) * size > enough)] = 1
    new[((side < 0) & (slope < -enough)) | ((side > 0) & (slope > enough))] = 0
    return np.where(lower < upper, new, side)


def _tolerance(linear, size, weights):
    """Return the slope (..., 1), per unit of a column's length, that counts as rounding."""
    largest = np.maximum(np.abs(linear / size), np.abs(size * weights))
    return _OPTIMAL * largest.max(axis=-1, keepdims=True, initial=0.0)


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
    side = _sides(weights, lower, upper)
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
    return np.abs(weights - np.clip(weights - step, lower, upper)).max(axis=1, initial=0.0)
