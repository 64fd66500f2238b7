"""Weights of either sign and any size as morph targets whose weights stay between 0 and 1.

Packages clamp morph weights to that range (Unity by default; Blender's importer outside the range
that the first key has), and a clamped weight is a wrong face.
"""

from typing import NamedTuple

import numpy as np


class Sides(NamedTuple):
    """Hold the targets that shapes are split into.

    Attributes
    ----------
    shape : (M,) int array, the shape that each target comes from
    gain : (M,) float array, what its differences are multiplied by; negative on the minus side
    weights : (T, M) float array in 0..1
    """

    shape: np.ndarray
    gain: np.ndarray
    weights: np.ndarray


def split(weights: np.ndarray) -> Sides:
    """Split weights into plus sides, one a shape, and minus sides where they are needed.

    With `g_m` the gains and `v_m` the new weights, `sum_m g_m v_m d_m = sum_i w_i d_i` at every
    frame and, as both are interpolated linearly, between the frames.

    Parameters
    ----------
    weights : (T, K) float array

    Returns
    -------
    Sides
        plus sides in the order of the shapes, then minus sides

    Raises
    ------
    ValueError
        if there is no frame
    """
    if weights.ndim != 2 or len(weights) == 0:
        raise ValueError(f"expected (T, K) weights of at least one frame, got {weights.shape}")
    low, high = weights.min(axis=0), weights.max(axis=0)
    below = np.flatnonzero(low < 0)
    shape = np.concatenate([np.arange(weights.shape[1]), below])
    gain = np.concatenate([np.maximum(high, 1.0), -np.maximum(-low[below], 1.0)])
    return Sides(shape, gain, np.maximum(weights[:, shape] / gain, 0.0))
