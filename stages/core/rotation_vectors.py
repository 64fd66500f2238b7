"""Rotations as vectors along their axis, as long as their angle: turns that can be scaled."""

import numpy as np

from stages.core import resample


def from_quaternions(quaternions: np.ndarray) -> np.ndarray:
    """Return the rotation vectors of a motion, without a jump.

    Parameters
    ----------
    quaternions : (T, 4) float array, x, y, z, w, of length one; NaN where not known

    Returns
    -------
    (T, 3) float array about x, y and z [rad]; the first turn is at most half a turn, and a motion
    may go on from there to a whole one
    """
    made = np.full((len(quaternions), 3), np.nan)
    known = np.isfinite(quaternions).all(axis=1)
    if not known.any():
        return made
    turns = resample.continuous(quaternions[known])
    turns = turns if turns[0, 3] >= 0.0 else -turns
    length = np.linalg.norm(turns[:, :3], axis=1)
    angle = 2.0 * np.arctan2(length, turns[:, 3])
    # near no turn at all, the vector part is half the rotation vector
    scale = np.where(length > 1e-12, angle / np.where(length > 1e-12, length, 1.0), 2.0)
    made[known] = turns[:, :3] * scale[:, None]
    return made


def to_quaternions(vectors: np.ndarray) -> np.ndarray:
    """Return the quaternions (T, 4) of rotation vectors (T, 3) [rad]."""
    angle = np.linalg.norm(vectors, axis=1, keepdims=True)
    # sinc is sin(pi x) / (pi x)
    axis = vectors * np.sinc(angle / (2.0 * np.pi)) / 2.0
    return np.concatenate([axis, np.cos(angle / 2.0)], axis=1)
