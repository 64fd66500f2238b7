"""Rotations as quaternions x, y, z, w."""

import numpy as np


def from_matrices(rotation: np.ndarray) -> np.ndarray:
    """Return the quaternions of rotation matrices (Shepperd 1978: the largest part by its root).

    Parameters
    ----------
    rotation : (T, 3, 3) float array

    Returns
    -------
    (T, 4) float array of length one, of either sign; NaN where the matrix is
    """
    diagonal = np.diagonal(rotation, axis1=1, axis2=2)
    trace = diagonal.sum(axis=1, keepdims=True)
    # the products of the parts: 4 q q', of which the column with the largest square is divided
    products = np.empty((len(rotation), 4, 4))
    squares = np.concatenate([1 + 2 * diagonal - trace, 1 + trace], axis=1)
    for row in range(4):
        products[:, row, row] = squares[:, row]
    for row, (i, j) in enumerate([(2, 1), (0, 2), (1, 0)]):
        products[:, row, 3] = products[:, 3, row] = rotation[:, i, j] - rotation[:, j, i]
        products[:, i, j] = products[:, j, i] = rotation[:, i, j] + rotation[:, j, i]
    largest = np.argmax(squares, axis=1)
    column = products[np.arange(len(rotation)), :, largest]
    return column / np.linalg.norm(column, axis=1, keepdims=True)


def from_angles(angles: np.ndarray) -> np.ndarray:
    """Return the quaternions of turns about z, then x, then y: roll, pitch, yaw.

    Parameters
    ----------
    angles : (T, 3) float array about y, x and z [rad]

    Returns
    -------
    (T, 4) float array of length one
    """
    (sy, sx, sz), (cy, cx, cz) = np.sin(angles.T / 2), np.cos(angles.T / 2)
    x = cy * sx * cz + sy * cx * sz
    y = sy * cx * cz - cy * sx * sz
    z = cy * cx * sz - sy * sx * cz
    w = cy * cx * cz + sy * sx * sz
    return np.stack([x, y, z, w], axis=1)
