"""The one contract for what moves: neutral plus masked, weighted shape differences.

    x(v, t) = H_t [ N(v) + sum_l M_l(v) sum_i u_li(t) (B_i(v) - N(v)) ]

The part in brackets is here; the head motion `H_t` is in `head_transform`.
"""

import numpy as np


def mask_deltas(deltas: np.ndarray, masks: np.ndarray, mask_index: np.ndarray) -> np.ndarray:
    """Multiply every shape's difference from the neutral by its mask.

    Parameters
    ----------
    deltas : (K, V, D) float array, `B_i - N` [character's unit]
    masks : (R, V) float array, one at every vertex in sum
    mask_index : (K,) int array, the mask of each shape

    Returns
    -------
    (K, V, D) float array, `M_l (B_i - N)`

    Raises
    ------
    ValueError
        if the shapes do not fit together
    """
    if deltas.ndim != 3 or masks.shape[1:] != deltas.shape[1:2] or len(mask_index) != len(deltas):
        raise ValueError(
            f"deltas {deltas.shape}, masks {masks.shape} and mask_index {mask_index.shape}"
            " are not (K, V, D), (R, V) and (K,)"
        )
    return deltas * masks[mask_index][:, :, None]


def compose(neutral: np.ndarray, masked: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Add the weighted shape differences of one frame to the neutral.

    Parameters
    ----------
    neutral : (V, D) float array [character's unit]
    masked : (K, V, D) float array from `mask_deltas`
    weights : (K,) float array, `u_li` of the frame

    Returns
    -------
    (V, D) float array [character's unit]

    Raises
    ------
    ValueError
        if the shapes do not fit together
    """
    if masked.shape != (len(weights), *neutral.shape):
        raise ValueError(
            f"masked {masked.shape}, weights {weights.shape}, neutral {neutral.shape} do not fit"
        )
    return neutral + (weights @ masked.reshape(len(weights), -1)).reshape(neutral.shape)
