"""The nearest point of a simplex to every frame, exactly."""

import numpy as np

from stages.core import box_least_squares


def solve(corners, frames):
    """Minimise ``|x_t - sum_i w_i c_i|^2`` over ``w >= 0`` with ``sum_i w_i = 1``.

    With ``w = s p``, p on the simplex, ``|sum_i w_i (c_i - x)|^2 + m (1 - sum_i w_i)^2`` is
    ``s^2 q(p) + m (1 - s)^2``; its minimum over s, ``m q / (q + m)``, rises with q. So the
    non-negative minimum, divided by its sum, is the answer for any m > 0.

    Parameters
    ----------
    corners : (K, D) float array
    frames : (T, D) float array

    Returns
    -------
    weights : (T, K) float array
    kkt_residual : (T,) float array
        Largest change that one weight still wants to make, the sum's multiplier given.

    Raises
    ------
    ValueError
        When there is no corner or the shapes do not fit.
    """
    corners, frames = np.asarray(corners, float), np.asarray(frames, float)
    if not len(corners) or corners.shape[1:] != frames.shape[1:]:
        raise ValueError(f"corners {corners.shape} do not fit frames {frames.shape}")
    centre = corners.mean(axis=0)
    R, z, rest = box_least_squares.reduce((corners - centre).T, frames - centre)
    margin = np.sum(R**2) / len(corners) or 1.0
    lower, upper = np.zeros(len(corners)), np.full(len(corners), np.inf)
    start = np.zeros(len(corners))
    weights, kkt_residual = np.empty((len(frames), len(corners))), np.empty(len(frames))
    for t in range(len(frames)):
        spread = R - z[t][:, None]
        gram = spread.T @ spread + rest[t] ** 2
        start = box_least_squares.solve_gram(
            gram + margin, np.full(len(corners), margin), lower, upper, start
        )
        weights[t] = start / start.sum()
        kkt_residual[t] = _kkt_residual(gram, weights[t])
    return weights, kkt_residual


def _kkt_residual(gram, weights):
    """Return how far the weights are from stationary on the simplex."""
    slope = gram @ weights
    step = (slope - weights @ slope) / np.maximum(gram.diagonal(), np.finfo(float).tiny)
    return np.abs(weights - np.maximum(weights - step, 0.0)).max()
