"""Principal components of one region's features (CB02 section 4.2)."""

from typing import NamedTuple

import numpy as np


class Pca(NamedTuple):
    """Hold the axes of a region, largest variance first.

    Attributes
    ----------
    mean : (D,) float array [feature unit]
    components : (C, D) float array, orthonormal rows
    variance : (C,) float array [feature unit squared]
    """

    mean: np.ndarray
    components: np.ndarray
    variance: np.ndarray


def fit(frames):
    """Find the orthonormal axes E that minimise ``sum_t |x_t - mean - E' E (x_t - mean)|^2``.

    The sign of every axis is fixed: its entry of largest magnitude is positive.

    Parameters
    ----------
    frames : (T, D) float array [feature unit]

    Returns
    -------
    Pca
        With C = min(T - 1, D) axes, fewer when the frames span less.

    Raises
    ------
    ValueError
        When there are fewer than two frames, or a value is not finite.

    Notes
    -----
    CB02 section 4.2.
    """
    frames = np.asarray(frames, float)
    if frames.ndim != 2 or len(frames) < 2:
        raise ValueError(f"PCA needs at least two frames, got an array of shape {frames.shape}")
    if not np.isfinite(frames).all():
        raise ValueError(f"PCA needs finite values in all {frames.shape} frames")
    mean = frames.mean(axis=0)
    _, singular, axes = np.linalg.svd(frames - mean, full_matrices=False)
    scale = max(singular[0], np.abs(mean).max())
    kept = singular > scale * max(frames.shape) * np.finfo(float).eps
    axes, singular = axes[kept], singular[kept]
    largest = np.abs(axes).argmax(axis=1)
    signs = np.sign(axes[np.arange(len(axes)), largest])
    return Pca(mean, axes * signs[:, None], singular**2 / (len(frames) - 1))


def project(model, frames):
    """Return the coordinates (T, C) of frames (T, D) on the axes of a model."""
    return (np.asarray(frames, float) - model.mean) @ model.components.T


def explained(model):
    """Return the fraction (C,) of the variance that the first 1 .. C axes hold together."""
    total = np.cumsum(model.variance)
    return total / total[-1] if len(total) else total
