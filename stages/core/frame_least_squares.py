"""Bounded weights of every frame on its own, for rigs of any size."""

import numpy as np

from stages.core import box_least_squares, clip_window

_FRAMES = 256


def solve(matrix, targets, lower, upper, ridge=0.0, tolerance=1e-6):
    """Minimise ``|A w_t - x_t|^2 + ridge |w_t|^2`` subject to ``lower <= w_t <= upper``.

    Coordinates that were not observed are left out. Frames with the same coordinates share their
    factorisation, some hundreds of them are solved together, and each leaves when it is done; the
    few that do not get there, where shapes nearly depend on one another, are solved exactly.

    Parameters
    ----------
    matrix : (D, K) float array
    targets : (T, D) float array
        NaN where not observed.
    lower, upper : (K,) float array
        Infinities stand for no bound.
    ridge : float
        Positive where the matrix alone, with the points that are missing, leaves weights open.
    tolerance : float
        Of the KKT residual.

    Returns
    -------
    weights : (T, K) float array
    kkt_residual : (T,) float array
        Largest change that one weight alone still wants to make.
    """
    shapes = matrix.shape[1]
    weights, residual = np.zeros((len(targets), shapes)), np.zeros(len(targets))
    none, free = np.zeros((0, shapes)), np.zeros(shapes)
    patterns, which = np.unique(np.isfinite(targets), axis=0, return_inverse=True)
    for number, pattern in enumerate(patterns):
        given = clip_window.problem(matrix[pattern], ridge, free, lower, upper)
        frames = np.flatnonzero(which.ravel() == number)
        for rows in np.split(frames, range(_FRAMES, len(frames), _FRAMES)):
            right = targets[rows][:, pattern] @ given.matrix
            window = clip_window.Window(right, right, None, none, none)
            weights[rows] = clip_window.solve(given, window, tolerance)
            residual[rows] = clip_window.kkt_residual(given, window, weights[rows])
            unfinished = np.flatnonzero(residual[rows] > tolerance)
            for place in unfinished:
                weights[rows[place]] = box_least_squares.solve_gram(
                    given.gram, right[place], lower, upper, weights[rows[place]]
                )
            if len(unfinished):
                residual[rows] = clip_window.kkt_residual(given, window, weights[rows])
    return weights, residual
