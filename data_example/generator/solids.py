"""Measure distances to rounded solids, and trace rays to their surface."""

import numpy as np


def ellipsoid(points, centre, radii):
    """Return the approximate signed distance to an axis-aligned ellipsoid."""
    q = (points - np.asarray(centre, float)) / np.asarray(radii, float)
    length = np.linalg.norm(q, axis=-1)
    slope = np.linalg.norm(q / np.asarray(radii, float), axis=-1)
    return length * (length - 1) / np.maximum(slope, 1e-9)


def capsule(points, start, end, radius_start, radius_end):
    """Return the signed distance to a rod whose radius changes linearly."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    axis = end - start
    t = np.clip((points - start) @ axis / (axis @ axis), 0, 1)
    offset = points - start - t[..., None] * axis
    return np.linalg.norm(offset, axis=-1) - (radius_start + t * (radius_end - radius_start))


def join(a, b, k):
    """Return the union of two distances, rounded over the width k."""
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.minimum(a, b) - h * h * k / 4


def cut(a, b, k):
    """Return the distance to a without b, rounded over the width k."""
    return -join(-a, b, k)


def trace(distance, origins, directions, start, steps=110):
    """Walk inwards along rays from outside until the surface is met.

    Parameters
    ----------
    distance : function from (N, 3) points to (N,) signed distances
    origins : (N, 3) float array [mm]
    directions : (N, 3) float array, unit vectors pointing outwards
    start : float, length along the ray to start from [mm]
    steps : int

    Returns
    -------
    t : (N,) float array, length along the ray at the surface [mm]
    """
    t = np.full(len(origins), float(start))
    for _ in range(steps):
        t -= 0.6 * distance(origins + t[:, None] * directions)
        t = np.maximum(t, 1.0)
    return t
