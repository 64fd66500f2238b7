"""A line through points of which some are far off."""

from typing import NamedTuple

import numpy as np

ROUNDS = 30
# Tukey's biweight: 95 % efficient for normal errors, blind to what is further off
CUT_OFF = 4.685
MAD_TO_SIGMA = 1.4826
# fewer points say nothing about the error of a slope
FEWEST = 4


class Line(NamedTuple):
    """`y = level + slope * (x - centre)`.

    spread : standard deviation of x among the points that it rests on
    slope_error : standard error of the slope; infinite where it was not fitted
    """

    level: float
    slope: float
    centre: float
    spread: float
    slope_error: float

    def at(self, x: float) -> float:
        """Return y at x."""
        return self.level + self.slope * (x - self.centre)


def robust(x: np.ndarray, y: np.ndarray, weight: np.ndarray, sloping: bool, finest: float) -> Line:
    """Fit a line by iteratively re-weighted least squares with Tukey's biweight.

    Minimises `sum w rho((y - level - slope (x - centre)) / sigma)`, sigma from the median absolute
    residual.

    Parameters
    ----------
    x, y, weight : (N,) float arrays
    sloping : whether the line may slope; else a robust mean
    finest : errors are not taken to be less [unit of y]

    Raises
    ------
    ValueError
        if there is no point, or the lengths differ
    """
    if not len(x) or not len(x) == len(y) == len(weight):
        raise ValueError(f"expected points (N,), got {x.shape}, {y.shape}, {weight.shape}")
    level, slope, centre, trust = _weighted_median(y, weight), 0.0, 0.0, weight
    for _ in range(ROUNDS):
        apart = np.abs(y - level - slope * (x - centre))
        sigma = max(MAD_TO_SIGMA * _weighted_median(apart, weight), finest)
        trust = weight * np.maximum(1 - (apart / (CUT_OFF * sigma)) ** 2, 0) ** 2
        centre = float(np.average(x, weights=trust))
        level = float(np.average(y, weights=trust))
        moment = float(np.sum(trust * (x - centre) ** 2))
        if sloping and moment > 0:
            slope = float(np.sum(trust * (x - centre) * (y - level)) / moment)
    spread = float(np.sqrt(moment / np.sum(trust)))
    if not sloping or np.count_nonzero(trust) < FEWEST:
        return Line(level, slope, centre, spread, np.inf)
    apart = np.maximum(np.abs(y - level - slope * (x - centre)), finest)
    slope_error = float(np.sqrt(np.sum((trust * (x - centre) * apart) ** 2)) / moment)
    return Line(level, slope, centre, spread, slope_error)


def _weighted_median(values: np.ndarray, weight: np.ndarray) -> float:
    """Return the value below which half the weight lies."""
    order = np.argsort(values, kind="stable")
    sums = np.cumsum(weight[order])
    return float(values[order[np.searchsorted(sums, sums[-1] / 2)]])
