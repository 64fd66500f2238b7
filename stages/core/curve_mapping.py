"""Curves of one set of shapes as weights of another, and what gets lost between them."""

from collections.abc import Sequence

import numpy as np


def apply(values: np.ndarray, sources: Sequence[Sequence[int]]) -> np.ndarray:
    """Return the weights of shapes, each the mean of the curves that it stands for.

    Parameters
    ----------
    values : (T, C) float array
    sources : for each of K shapes its curves; none leaves it at 0

    Returns
    -------
    (T, K) float array
    """
    still = np.zeros(len(values))
    columns = [values[:, list(own)].mean(axis=1) if own else still for own in sources]
    return np.stack(columns, axis=1)


def motion(values: np.ndarray) -> np.ndarray:
    """Return how much each curve moves: its standard deviation over the frames (C,)."""
    return np.std(values, axis=0)
