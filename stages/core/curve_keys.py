"""Keys that say a curve exactly where programs interpolate linearly between them."""

import numpy as np


def needed(values: np.ndarray) -> np.ndarray:
    """Return the rows (N,) of a curve that have to be keys: all but those inside a constant run.

    Parameters
    ----------
    values : (T,) float array

    Raises
    ------
    ValueError
        if there is no value
    """
    if np.ndim(values) != 1 or not len(values):
        raise ValueError(f"expected (T,) values of at least one frame, got {np.shape(values)}")
    changes = np.flatnonzero(np.diff(values) != 0)
    if not len(changes):
        return np.zeros(1, int)
    return np.unique(np.concatenate([[0, len(values) - 1], changes, changes + 1]))
