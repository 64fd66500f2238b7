"""Compose a face from its layers (K11 eq. 4 and 5)."""

import numpy as np


def displacements(
    layer: np.ndarray, weights: np.ndarray, coefficients: np.ndarray, amplitudes: np.ndarray
) -> np.ndarray:
    """Return how much of each extreme each mask shows, ``u_lk = s_l w[l, j(k)] a_k``.

    Parameters
    ----------
    layer : (K,) int array, the layer of each extreme
    weights : (T, R, J) float array
    coefficients : (T, K) float array
    amplitudes : (T, R) float array

    Returns
    -------
    (T, R, K) float array
    """
    return (weights * amplitudes[:, :, None])[:, :, layer] * coefficients[:, None]


def composed(basis: np.ndarray, masks: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return ``sum_l M_l B u_l``, the offsets (T, D) from the neutral.

    Parameters
    ----------
    basis : (D, K) float array, extremes less the neutral
    masks : (R, D) float array
    u : (T, R, K) float array, as `displacements` gives

    Raises
    ------
    ValueError
        if the shapes do not fit together
    """
    if basis.shape[1:] != u.shape[2:] or masks.shape != (u.shape[1], len(basis)):
        raise ValueError(f"basis {basis.shape}, masks {masks.shape} and u {u.shape} do not fit")
    found = np.zeros((len(u), len(basis)))
    for mask, own in zip(masks, np.moveaxis(u, 1, 0), strict=True):
        found += mask * (own @ basis.T)
    return found
