"""Find extremes of one layer that nearly coincide, between which no coefficient can tell."""

from typing import NamedTuple

import numpy as np

# neighbouring frames of a pose that is held still are as far apart by noise alone
NEAR = 0.15


class NearPair(NamedTuple):
    """Hold two extremes and their distance, as a share of the mean distance in their layer."""

    first: int
    second: int
    share: float


def find(basis: np.ndarray, layer: np.ndarray, near: float = NEAR) -> list[NearPair]:
    """Return the pairs of a layer that are nearer than a share of its mean distance.

    Parameters
    ----------
    basis : (D, K) float array, extremes [balanced]
    layer : (K,) int array, the layer of each
    near : the share; a layer whose extremes are all the same is near throughout

    Raises
    ------
    ValueError
        if the shapes differ
    """
    if np.shape(layer) != basis.shape[1:]:
        raise ValueError(f"layer {np.shape(layer)} for a basis {basis.shape}")
    found = []
    for number in np.unique(layer):
        own = np.flatnonzero(layer == number)
        first, second = np.triu_indices(len(own), 1)
        if len(first) == 0:
            continue
        distance = np.linalg.norm(basis[:, own[first]] - basis[:, own[second]], axis=0)
        share = distance / max(distance.mean(), np.finfo(float).tiny)
        close = np.flatnonzero(share < near)
        close = close[np.argsort(share[close], kind="stable")]
        found += [NearPair(int(own[first[i]]), int(own[second[i]]), share[i]) for i in close]
    return found
