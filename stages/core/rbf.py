"""Gaussian radial basis functions round examples (D06 equation 4)."""

import numpy as np


def squared_distances(points, centres):
    """Return the squared distances (T, N) of points (T, C) from centres (N, C)."""
    square = np.sum(points**2, axis=1)[:, None] + np.sum(centres**2, axis=1)
    return np.maximum(square - 2 * points @ centres.T, 0.0)


def nearest_distance(centres):
    """Return the median distance of a centre from the nearest other one.

    Centres at the same place, as of two animators who tuned one frame, count as one. One where
    there is nothing to measure.

    Parameters
    ----------
    centres : (N, C) float array
    """
    places = np.unique(centres, axis=0)
    if len(places) < 2:
        return 1.0
    distance = np.sqrt(squared_distances(places, places))
    np.fill_diagonal(distance, np.inf)
    return float(np.median(distance.min(axis=1)))


def usual_factor(centres):
    """Return the RMS distance of two centres over that of a centre from the nearest other."""
    places = np.unique(centres, axis=0)
    if len(places) < 2:
        return 1.0
    apart = squared_distances(places, places)[np.triu_indices(len(places), 1)]
    return float(np.sqrt(apart.mean())) / nearest_distance(centres)


def basis(points, centres, width):
    """Return ``exp(-|x - c_k|^2 / 2 width^2)`` of every point and centre.

    Parameters
    ----------
    points : (T, C) float array
    centres : (N, C) float array
    width : float
        One for all centres, in the points' unit.

    Returns
    -------
    (T, N) float array

    Notes
    -----
    D06 equation 4, with one sigma for all k.
    """
    return np.exp(-squared_distances(points, centres) / (2 * width**2))
