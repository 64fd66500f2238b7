"""How nearly closed the lips are, for the bias towards /m/ (K11 section 4)."""

import numpy as np


def closeness(gap: np.ndarray, closed: float, sigma: float) -> np.ndarray:
    """Return ``gamma = exp(-d^2 / (2 sigma^2))`` with ``d = max(gap - closed, 0)``.

    The paper takes the distance itself; less that of closed lips, which differs from face to face
    and with where the points sit, lips that touch have gamma 1.

    Parameters
    ----------
    gap : (T,) float array, distance of the lips; NaN where not observed, there gamma is 0
    closed : that distance where the lips are closed
    sigma : float, above 0, in the same unit

    Raises
    ------
    ValueError
        if sigma is not above 0, or `closed` is not finite
    """
    if not (0 < sigma < np.inf and np.isfinite(closed)):
        raise ValueError(f"sigma {sigma} must be above 0 and closed {closed} finite")
    apart = np.maximum(np.asarray(gap, float) - closed, 0.0)
    return np.nan_to_num(np.exp(-((apart / sigma) ** 2) / 2))
