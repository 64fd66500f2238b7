"""Let layers exceed their extremes: a bounded ridge least squares on one amplitude per layer."""

import numpy as np

SWEEPS = 200


def solve(
    products: np.ndarray,
    linear: np.ndarray,
    pull: float,
    centre: np.ndarray,
    beyond: float,
) -> np.ndarray:
    """Minimise ``s' products s - 2 linear's + pull |s - centre|^2`` over ``1 <= s <= 1 + beyond``.

    Parameters
    ----------
    products : (J, J) float array, inner products of the layers' displacements
    linear : (J,) float array, their inner products with the frame
    pull : float, above zero
    centre : (J,) float array
    beyond : float, how far an amplitude may exceed one

    Returns
    -------
    amplitudes : (J,) float array
    """
    point = np.ones(len(linear))
    for _ in range(SWEEPS):
        before = point.copy()
        for j in range(len(point)):
            others = products[j] @ point - products[j, j] * point[j]
            best = (linear[j] + pull * centre[j] - others) / (products[j, j] + pull)
            point[j] = min(max(best, 1.0), 1.0 + beyond)
        if np.abs(point - before).max() < 1e-9:
            break
    return point
