"""Motion of a rigid body in space: the rotation and translation from the neutral to a frame.

D06 section 3 moves a chosen marker to the origin of every frame and takes the rotation from the
singular value decomposition of `y' x` with points as rows (equations 1 and 2): `x_p = V U' y_p`
for columns. Its `V U'` is a reflection where the points lie almost in a plane; here the sign of
the least singular vector is turned then, so that it is always a rotation.
"""

import numpy as np

MIN_POINTS = 4
CHUNK = 4096  # frames at a time, so that long takes need no memory of their length
FLAT = 1e-4  # points on a line leave the turn about it open


def fit(
    points: np.ndarray, neutral: np.ndarray, weights: np.ndarray, origin: int | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Fit a rotation and a translation to every frame.

    Minimises, for each frame, `sum_p w_p |x_p - R n_p - t|^2` over rotations `R`, and over `t`;
    with an origin, `t` is the one that brings that point to its place.

    Parameters
    ----------
    points : (T, P, 3) float array; NaN where not observed
    neutral : (P, 3) float array
    weights : (P,) or (T, P) float array, not negative
    origin : row of the point that is moved to the origin; None takes the weighted centroid

    Returns
    -------
    rotation : (T, 3, 3) float array; NaN where fewer than four points count, all that count lie
        on one line, or the origin is not observed
    translation : (T, 3) float array

    Raises
    ------
    ValueError
        if the shapes disagree
    """
    frames, count = points.shape[:2]
    if points.shape[1:] != neutral.shape or neutral.shape[1:] != (3,):
        raise ValueError(f"expected (T, P, 3) and (P, 3), got {points.shape} and {neutral.shape}")
    if weights.shape not in ((count,), (frames, count)):
        raise ValueError(f"weights are {weights.shape}, points {points.shape}")
    rotation, translation = np.empty((frames, 3, 3)), np.empty((frames, 3))
    for start in range(0, frames, CHUNK):
        part = slice(start, start + CHUNK)
        chosen = weights if weights.ndim == 1 else weights[part]
        rotation[part], translation[part] = _fit(points[part], neutral, chosen, origin)
    return rotation, translation


def _fit(
    points: np.ndarray, neutral: np.ndarray, weights: np.ndarray, origin: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return rotations and translations of a few frames."""
    observed = np.isfinite(points).all(axis=2)
    weights = np.where(observed, weights, 0.0)
    points = np.where(observed[..., None], points, 0.0)
    total = weights.sum(axis=1)
    known = ((weights > 0).sum(axis=1) >= MIN_POINTS) & (total > 0)
    if origin is None:
        weights = weights / np.where(known, total, 1.0)[:, None]
        here = np.einsum("tp,tpi->ti", weights, points)
        there = weights @ neutral
    else:
        known &= observed[:, origin]
        here = points[:, origin]
        there = np.broadcast_to(neutral[origin], here.shape)
    weighted = weights[..., None] * (points - here[:, None])
    # sum_p w x (n - c)' = sum_p w x n' - (sum_p w x) c'
    product = weighted.transpose(0, 2, 1) @ neutral
    product -= weighted.sum(axis=1)[:, :, None] * there[:, None, :]
    left, sizes, right = np.linalg.svd(product)
    known &= sizes[:, 1] > FLAT * sizes[:, 0]
    left[:, :, 2] *= np.sign(np.linalg.det(left @ right))[:, None]
    rotation = left @ right
    rotation[~known] = np.nan
    return rotation, here - np.einsum("tij,tj->ti", rotation, there)


def remove(points: np.ndarray, rotation: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """Return the points with the motion undone, `R' (x - t)`.

    Parameters
    ----------
    points : (T, P, 3) float array
    rotation : (T, 3, 3) float array
    translation : (T, 3) float array

    Returns
    -------
    (T, P, 3) float array of the points' precision; NaN where the motion is unknown
    """
    kind = points.dtype
    return (points - translation[:, None].astype(kind)) @ rotation.astype(kind)


def squared_residuals(
    points: np.ndarray, neutral: np.ndarray, rotation: np.ndarray, translation: np.ndarray
) -> np.ndarray:
    """Return `|R' (x_p - t) - n_p|^2`, (T, P)."""
    return np.sum((remove(points, rotation, translation) - neutral) ** 2, axis=2)
