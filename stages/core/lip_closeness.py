"""How nearly closed the lips are, for the bias of closed lips (K11 section 4)."""

import numpy as np

STEEPNESS = 8


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
    apart = _apart(gap, closed, sigma)
    return np.nan_to_num(np.exp(-((apart / sigma) ** 2) / 2))


def steep(gap: np.ndarray, closed: float, sigma: float) -> np.ndarray:
    """Return ``g = 1 / (1 + (d / sigma)^8)`` with d as in `closeness`: one half at sigma.

    A term weighted by ``g / (1 - g) = (sigma / d)^8`` decides between closed and open about sigma.
    By the paper's gamma that ratio falls so slowly that it closes lips out to twice sigma, on one
    character further than on the next.

    Parameters
    ----------
    gap, closed, sigma : see `closeness`

    Raises
    ------
    ValueError
        if sigma is not above 0, or `closed` is not finite
    """
    with np.errstate(over="ignore"):
        return np.nan_to_num(1.0 / (1.0 + (_apart(gap, closed, sigma) / sigma) ** STEEPNESS))


def _apart(gap: np.ndarray, closed: float, sigma: float) -> np.ndarray:
    """Return how much further apart than closed ones the lips are (T,)."""
    if not (0 < sigma < np.inf and np.isfinite(closed)):
        raise ValueError(f"sigma {sigma} must be above 0 and closed {closed} finite")
    return np.maximum(np.asarray(gap, float) - closed, 0.0)
