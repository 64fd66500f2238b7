"""Similarities and affine maps of the plane, as (2, 3) matrices `[A | t]`, and mean shapes."""

from collections.abc import Iterable

import numpy as np


def apply(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the points (..., 2) mapped by a (2, 3) matrix."""
    return points @ matrix[:, :2].T + matrix[:, 2]


def unapply(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the points (..., 2) that a (2, 3) matrix maps to the given ones."""
    return apply(invert(matrix), points)


def invert(matrix: np.ndarray) -> np.ndarray:
    """Return the (2, 3) matrix that undoes one."""
    linear = np.linalg.inv(matrix[:, :2])
    return np.hstack([linear, -(linear @ matrix[:, 2:])])


def compose(outer: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """Return the (2, 3) matrix that applies `inner`, then `outer`."""
    linear = outer[:, :2] @ inner[:, :2]
    return np.hstack([linear, (outer[:, :2] @ inner[:, 2] + outer[:, 2])[:, None]])


def about(centre: np.ndarray, angle: float, scale: float, shift: np.ndarray) -> np.ndarray:
    """Return the similarity that turns [rad] and scales about a centre, then shifts."""
    linear = scale * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.hstack([linear, (centre - linear @ centre + shift)[:, None]])


def fit_similarity(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Fit translation, rotation and scale: minimise `sum_p |s R x_p + t - y_p|^2`.

    Parameters
    ----------
    source : (P, 2) float array, the points `x_p`
    target : (P, 2) float array, the points `y_p`

    Returns
    -------
    (2, 3) float array; never a reflection

    Raises
    ------
    ValueError
        if the shapes differ or the source is a single place
    """
    _check(source, target)
    from_mean, to_mean = source.mean(axis=0), target.mean(axis=0)
    x, y = source - from_mean, target - to_mean
    size = (x * x).sum()
    if size <= 0:
        raise ValueError(f"{len(source)} points in one place fix no similarity")
    a = (x * y).sum() / size
    b = (x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]).sum() / size
    linear = np.array([[a, -b], [b, a]])
    return np.hstack([linear, (to_mean - linear @ from_mean)[:, None]])


def fit_affine(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Fit an affine map: minimise `sum_p |A x_p + t - y_p|^2`.

    Parameters
    ----------
    source : (P, 2) float array, the points `x_p`
    target : (P, 2) float array, the points `y_p`

    Returns
    -------
    (2, 3) float array

    Raises
    ------
    ValueError
        if the shapes differ
    """
    _check(source, target)
    rows = np.hstack([source, np.ones((len(source), 1))])
    return np.linalg.lstsq(rows, target, rcond=None)[0].T


def aligned(shapes: Iterable[np.ndarray], target: np.ndarray) -> np.ndarray:
    """Return shapes (N, P, 2), each brought by its similarity as near to a target as it comes."""
    return np.array([apply(fit_similarity(shape, target), shape) for shape in shapes])


def mean_shape(shapes: np.ndarray, radius: float, rounds: int = 10) -> np.ndarray:
    """Average shapes up to similarity (generalised Procrustes).

    Parameters
    ----------
    shapes : (N, P, 2) float array; the first sets the orientation
    radius : root mean square distance from the centre that the mean is scaled to
    rounds : number of alternations

    Returns
    -------
    (P, 2) float array about the origin
    """
    mean = shapes[0]
    for _ in range(rounds):
        average = aligned(shapes, mean).mean(axis=0)
        upright = apply(fit_similarity(average, shapes[0]), average)
        mean = upright - upright.mean(axis=0)
        mean *= radius / np.sqrt((mean**2).sum(axis=1).mean())
    return mean


def _check(source: np.ndarray, target: np.ndarray) -> None:
    """Refuse points that do not correspond."""
    if source.shape != target.shape or source.ndim != 2 or source.shape[1] != 2:
        raise ValueError(f"expected two arrays (P, 2), got {source.shape} and {target.shape}")
