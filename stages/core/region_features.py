"""The points of a region as feature vectors whose lengths are in face units per point."""

import numpy as np


def stack(points, weights):
    """Scale coordinates so that ``|f_a - f_b|^2 = sum_p v_p |a_p - b_p|^2 / sum_p v_p``.

    The distance of two features is the weighted root mean square distance of their points.

    Parameters
    ----------
    points : (T, P, 2) or (P, 2) float array [face units]
    weights : (P,) float array, not negative

    Returns
    -------
    (T, 2P) or (2P,) float array [face units]

    Raises
    ------
    ValueError
        When the shapes do not fit, or no weight is above zero.
    """
    points, weights = np.asarray(points, float), np.asarray(weights, float)
    if points.shape[-2:-1] != weights.shape or not (weights >= 0).all() or not weights.any():
        raise ValueError(f"weights {weights.shape} must fit points {points.shape} and be positive")
    scaled = points * np.sqrt(weights / weights.sum())[:, None]
    return scaled.reshape(*points.shape[:-2], -1)
