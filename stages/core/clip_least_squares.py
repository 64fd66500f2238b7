"""Bounded weights of a whole clip that are smooth in time, window by window."""

import numpy as np

from stages.core import clip_window, frame_least_squares

TOLERANCE = 1e-4
# of a window, and from one to the next
_FRAMES, _STEP = 256, 192
_PASSES = 12


def solve(matrix, targets, lower, upper, smooth, ridge=0.0, tolerance=TOLERANCE):
    """Minimise the misfit of all frames and the bends of all weights together, within bounds.

    ``sum_t |A w_t - x_t|^2 + ridge |w_t|^2 + sum_k smooth_k sum_t (w_t-1 - 2 w_t + w_t+1)_k^2``
    subject to ``lower <= w_t <= upper``. A weight that does not change, or changes evenly, costs
    nothing, so it is not drawn to zero. Coordinates that were not observed are left out.

    The clip is solved in windows, each with some frames of the next to look ahead; windows over
    their seams follow, until every frame satisfies the optimality conditions. So memory does not
    grow with the clip, but for what goes in and out.

    Parameters
    ----------
    matrix : (D, K) float array
    targets : (T, D) float array
        NaN where not observed.
    lower, upper : (K,) float array
        Infinities stand for no bound.
    smooth : (K,) float array
        0 for weights that are free to change from frame to frame.
    ridge : float
        Positive where the matrix alone, with the points that are missing, leaves weights open.
    tolerance : float
        Of the KKT residual.

    Returns
    -------
    weights : (T, K) float array
    kkt_residual : (T,) float array
        Largest change that one weight alone still wants to make; above `tolerance` where the
        windows did not come to an agreement.

    Raises
    ------
    ValueError
        When the shapes do not fit, or a strength is negative.
    """
    matrix, targets = np.asarray(matrix, float), np.asarray(targets, float)
    lower, upper, smooth = (np.asarray(array, float) for array in (lower, upper, smooth))
    _check(matrix, targets, lower, upper, smooth)
    if not smooth.any():
        return frame_least_squares.solve(matrix, targets, lower, upper, ridge, tolerance)
    given = clip_window.problem(matrix, ridge, smooth, lower, upper)
    weights = np.zeros((len(targets), matrix.shape[1]))
    for first, last in _windows(len(targets), 0):
        window = _window(given, targets, weights, first, last, last)
        weights[first:last] = clip_window.solve(given, window, tolerance / 2)
    for number in range(1, _PASSES):
        residual = _kkt_residual(given, targets, weights)
        if residual.max(initial=0.0) <= tolerance:
            break
        # windows in the middle of which the seams of those before lie, and those again
        for first, last in _windows(len(targets), (_STEP - _FRAMES // 2) * (number % 2)):
            window = _window(given, targets, weights, first, last, len(targets))
            start = weights[first:last]
            if clip_window.kkt_residual(given, window, start).max() > tolerance / 2:
                weights[first:last] = clip_window.solve(given, window, tolerance / 4, start)
    return weights, _kkt_residual(given, targets, weights)


def _check(matrix, targets, lower, upper, smooth):
    """Refuse arrays that do not fit."""
    if matrix.ndim != 2 or targets.ndim != 2 or targets.shape[1] != len(matrix):
        raise ValueError(f"targets {targets.shape} do not fit the matrix {matrix.shape}")
    for array in (lower, upper, smooth):
        if array.shape != matrix.shape[1:]:
            raise ValueError(f"limits or strengths {array.shape} do not fit {matrix.shape}")
    if (smooth < 0).any():
        raise ValueError(f"strengths from {smooth.min():g} on are negative")


def _windows(frames, offset):
    """Return first and last frame (excluded) of windows that overlap and reach the clip's end."""
    last = max(frames - _FRAMES, 0)
    starts = {min(start, last) for start in range(offset, last + _STEP, _STEP)}
    return [(start, min(start + _FRAMES, frames)) for start in sorted(starts)]


def _window(given, targets, weights, first, last, end):
    """Return frames of the clip as a window, held by two frames on either side, none after end."""
    part = targets[first:last]
    seen = np.isfinite(part)
    right = guess = np.where(seen, part, 0.0) @ given.matrix
    if not seen.all():
        guess = _bridged(part, seen) @ given.matrix
    before, after = weights[max(first - 2, 0) : first], weights[last : min(last + 2, end)]
    return clip_window.Window(right, guess, None if seen.all() else seen, before, after)


def _bridged(targets, seen):
    """Return targets (n, D) with straight lines over what was not observed."""
    bridged = np.where(seen, targets, 0.0)
    frames = np.arange(len(targets))
    for column in np.flatnonzero(~seen.all(axis=0) & seen.any(axis=0)):
        known = seen[:, column]
        bridged[:, column] = np.interp(frames, frames[known], targets[known, column])
    return bridged


def _kkt_residual(given, targets, weights):
    """Return the KKT residual (T,) of the clip."""
    residual = np.zeros(len(targets))
    for first in range(0, len(targets), _FRAMES):
        last = min(first + _FRAMES, len(targets))
        window = _window(given, targets, weights, first, last, len(targets))
        residual[first:last] = clip_window.kkt_residual(given, window, weights[first:last])
    return residual
