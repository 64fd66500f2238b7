"""Tell the gap of the lips from all that moves about them, where two points alone are noisy.

Tracked points of lips stray by a millimetre, as much as separates closed lips from open ones. Over
the frames of the basis shots the gap of the two is a linear function of all coordinates under the
lips' mask, markers too, plus noise that averages out.
"""

from typing import NamedTuple

import numpy as np

RIDGE = 3e-4  # of the coordinates' mean variance; least error near closed lips, cross-validated


class Estimate(NamedTuple):
    """Hold a linear function of coordinates: ``x @ weights + start``.

    Attributes
    ----------
    weights : (D,) float array
    start : float, the gap at the neutral
    """

    weights: np.ndarray
    start: float


def fit(offsets: np.ndarray, gap: np.ndarray, chosen: np.ndarray) -> Estimate | None:
    """Minimise ``sum_t (x_t w + b - gap_t)^2 + ridge |w|^2``; None with too few frames.

    Parameters
    ----------
    offsets : (T, D) float array [balanced]; frames with NaN where chosen are left out
    gap : (T,) float array, NaN where not observed
    chosen : (D,) bool array, coordinates that may tell, those of the lips' mask
    """
    known = np.isfinite(offsets[:, chosen]).all(axis=1) & np.isfinite(gap)
    x, y = offsets[known][:, chosen], gap[known]
    if len(x) <= x.shape[1]:
        return None
    centre = x.mean(axis=0)
    products = (x - centre).T @ (x - centre)
    ridge = RIDGE * max(np.trace(products) / len(centre), np.finfo(float).tiny)
    own = np.linalg.solve(products + ridge * np.eye(len(centre)), (x - centre).T @ (y - y.mean()))
    weights = np.zeros(offsets.shape[1])
    weights[chosen] = own
    return Estimate(weights, float(y.mean() - centre @ own))


def gap(estimate: Estimate, offsets: np.ndarray) -> np.ndarray:
    """Return the gap (T,) that offsets (T, D) tell of, NaN where a coordinate is missing."""
    told = estimate.weights != 0.0
    return offsets[:, told] @ estimate.weights[told] + estimate.start
