"""Layers turned up and down over time, and put together into what moves a rig (K11 eq. 5).

    u_lk(t) = w_l,layer(k)(t) a_k(t) amplitude_l(t) g_k(t)

What a gain below one takes from an extreme goes to the layer's neutral: where that is the
character's own, it moves nothing and is left out. The mask weights stay, so no other layer fills
the place.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class Direction(NamedTuple):
    """Hold one change of some extremes.

    Attributes
    ----------
    extremes : (n,) int array, rows among the K
    gain : 0 or more
    start_s, end_s : when it holds [s]; infinite where it has no end
    fade_s : how long it takes at either end, within the range [s]
    """

    extremes: np.ndarray
    gain: float
    start_s: float
    end_s: float
    fade_s: float


def presence(time_s: np.ndarray, start_s: float, end_s: float, fade_s: float) -> np.ndarray:
    """Rise smoothly from 0 at the start to 1, and fall to 0 at the end.

    Both take `fade_s` by the smoothstep ``3 x^2 - 2 x^3``; without it the range is half open.

    Parameters
    ----------
    time_s : (T,) float array [s]
    start_s, end_s, fade_s : as in `Direction`

    Returns
    -------
    (T,) float array in 0..1

    Raises
    ------
    ValueError
        if the range is empty or shorter than its fades, or these are negative
    """
    if not fade_s >= 0:
        raise ValueError(f"a fade of {fade_s:g} s is negative")
    if not end_s > start_s:
        raise ValueError(f"the end, {end_s:g} s, is not after the start, {start_s:g} s")
    if not end_s - start_s >= 2 * fade_s * (1 - 1e-9):
        raise ValueError(f"{start_s:g} s to {end_s:g} s leaves no room for fades of {fade_s:g} s")
    inside = (time_s >= start_s) & (time_s < end_s)
    if not fade_s:
        return inside.astype(float)
    nearest = np.minimum(time_s - start_s, end_s - time_s)
    share = np.clip(nearest, 0.0, fade_s) / fade_s
    return np.where(inside, share * share * (3.0 - 2.0 * share), 0.0)


def gains(time_s: np.ndarray, count: int, directions: Sequence[Direction]) -> np.ndarray:
    """Multiply all changes together; extremes that none names keep exactly 1.

    Parameters
    ----------
    time_s : (T,) float array [s]
    count : K
    directions : the changes

    Returns
    -------
    (T, K) float array
    """
    product = np.ones((len(time_s), count))
    for extremes, gain, *span in directions:
        product[:, extremes] *= (1.0 + (gain - 1.0) * presence(time_s, *span))[:, None]
    return product


def composed(
    weights: np.ndarray,
    coefficients: np.ndarray,
    amplitudes: np.ndarray,
    layer: np.ndarray,
    gain: np.ndarray,
    rest: np.ndarray,
) -> np.ndarray:
    """Multiply the factors of the layers into weights of extremes under masks.

    A layer's neutral r has ``a_r g_r + sum_k max(1 - g_k, 0) a_k`` in place of ``a_r g_r``.

    Parameters
    ----------
    weights : (T, R, J) float array, of the layers in each mask
    coefficients : (T, K) float array, of the extremes
    amplitudes : (T, R) float array, of the masks
    layer : (K,) int array, the layer of each extreme
    gain : (T, K) float array
    rest : (J,) int array, the neutral of each layer among the extremes; -1 where it is none of them

    Returns
    -------
    (T, R, K) float array

    Raises
    ------
    ValueError
        if the forms do not fit together
    """
    if weights.shape[:2] != amplitudes.shape or not (
        coefficients.shape == gain.shape == (len(weights), len(layer))
    ):
        raise ValueError(
            f"weights {weights.shape}, coefficients {coefficients.shape}, amplitudes"
            f" {amplitudes.shape}, layer {np.shape(layer)} and gain {gain.shape} do not fit"
        )
    shown, taken = coefficients * gain, coefficients * np.maximum(1.0 - gain, 0.0)
    for number, extreme in enumerate(rest):
        if extreme >= 0:
            shown[:, extreme] += taken[:, layer == number].sum(axis=1)
    return (weights * amplitudes[:, :, None])[:, :, layer] * shown[:, None, :]
