"""Rotations of a head as yaw, pitch and roll."""

import numpy as np


def from_quaternions(quaternions: np.ndarray) -> np.ndarray:
    """Return turns about y, x and z whose product, z first, then x, then y, is each rotation.

    The inverse of `quaternions.from_angles`.

    Parameters
    ----------
    quaternions : (T, 4) float array, x, y, z, w, of length one

    Returns
    -------
    (T, 3) float array about y, x and z, the second within a quarter turn [rad]
    """
    x, y, z, w = quaternions.T
    sine = np.clip(2 * (x * w - y * z), -1.0, 1.0)
    about_y = np.arctan2(2 * (x * z + y * w), 1 - 2 * (x * x + y * y))
    about_z = np.arctan2(2 * (x * y + z * w), 1 - 2 * (x * x + z * z))
    return np.stack([about_y, np.arcsin(sine), about_z], axis=1)


def about_fixed_axes(quaternions: np.ndarray) -> np.ndarray:
    """Return turns about x, y and z whose product, x first, then y, then z, is each rotation.

    Parameters
    ----------
    quaternions : (T, 4) float array, x, y, z, w, of length one

    Returns
    -------
    (T, 3) float array about x, y and z, the second within a quarter turn [rad]
    """
    x, y, z, w = quaternions.T
    about_x = np.arctan2(2 * (y * z + x * w), 1 - 2 * (x * x + y * y))
    sine = np.clip(2 * (y * w - x * z), -1.0, 1.0)
    about_z = np.arctan2(2 * (x * y + z * w), 1 - 2 * (y * y + z * z))
    return np.stack([about_x, np.arcsin(sine), about_z], axis=1)
