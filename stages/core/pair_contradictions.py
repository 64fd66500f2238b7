"""Tuned pairs that contradict the others: alike in the actor, unlike in the weights.

D06 section 8: pairs of animators with different preferences "involve a risk of causing conflicts".
"""

import numpy as np

from stages.core import rbf

# how near another pair must be to be blamed, in usual distances of neighbours
REACH = 2.0


def doubt(residuals, misfits):
    """Return how far each pair lies from what the others say, in terms of what one may expect.

    ``sqrt(mean_k e_nk^2 / P_nn)``, which is the misfit `e` over its own spread: a pair at the rim
    is always badly predicted from the others, and no worse for that.

    Parameters
    ----------
    residuals : (N, K) float array
        Of leaving one out, ``e / P``.
    misfits : (N, K) float array
        `e`, of the regression from all pairs.

    Returns
    -------
    (N,) float array [weight]
    """
    products = np.asarray(residuals, float) * np.asarray(misfits, float)
    return np.sqrt(np.maximum(np.mean(products, axis=1), 0.0))


def partners(coordinates, targets):
    """Return for each pair the one that it contradicts most.

    That is the pair of largest ``|y_i - y_j| exp(-|x_i - x_j|^2 / 2 r^2)``, with `r` twice the
    median distance of a pair from the nearest other.

    Parameters
    ----------
    coordinates : (N, C) float array
    targets : (N, K) float array

    Returns
    -------
    (N,) int array

    Raises
    ------
    ValueError
        When there are fewer than two pairs.
    """
    coordinates, targets = np.asarray(coordinates, float), np.asarray(targets, float)
    if len(coordinates) < 2:
        raise ValueError(f"{coordinates.shape}: contradictions need two pairs")
    reach = REACH * rbf.nearest_distance(coordinates)
    apart = rbf.squared_distances(targets, targets)
    with np.errstate(divide="ignore"):
        # in logarithms, so that the nearest is found however far all are
        blame = 0.5 * np.log(apart) - rbf.squared_distances(coordinates, coordinates) / (
            2 * reach**2
        )
    np.fill_diagonal(blame, -np.inf)
    first = (np.arange(len(blame)) + 1) % len(blame)
    return np.where(np.isfinite(blame.max(axis=1)), blame.argmax(axis=1), first)
