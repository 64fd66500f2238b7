"""Curves that are parts of a whole, as simplex weights are: none below zero, no greater sum."""

import numpy as np


def limited(values: np.ndarray, before: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Keep the parts of each whole above zero, and their sum below the greatest there was.

    Parameters
    ----------
    values : (T, K) float array, finite
    before : (T, K) float array, the parts before they were changed; NaN where not observed
    whole : (K,) int array, of which whole each curve is a part

    Returns
    -------
    (T, K) float array
    """
    made = np.maximum(values, 0.0)
    for number in np.unique(whole):
        part = whole == number
        sums = before[:, part].sum(axis=1)
        most = np.max(sums, where=np.isfinite(sums), initial=0.0)
        now = made[:, part].sum(axis=1)
        over = now > most
        made[np.ix_(over, part)] *= (most / now[over])[:, None]
    return made
