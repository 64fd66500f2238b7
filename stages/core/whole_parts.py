"""Curves that are parts of a whole, as simplex weights are: none below zero, no greater sum.

What was there before decides: a part that has been negative may be so again.
"""

import numpy as np


def limited(values: np.ndarray, before: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Keep parts from falling below zero or the least there was, their sum below the greatest.

    Parameters
    ----------
    values : (T, K) float array, finite
    before : (T, K) float array, the parts before they were changed; NaN where not observed
    whole : (K,) int array, of which whole each curve is a part

    Returns
    -------
    (T, K) float array
    """
    made = np.maximum(values, np.fmin(np.fmin.reduce(before, axis=0), 0.0))
    for number in np.unique(whole):
        part = whole == number
        sums = before[:, part].sum(axis=1)
        most = np.max(sums, where=np.isfinite(sums), initial=0.0)
        now = made[:, part].sum(axis=1)
        over = now > most
        made[np.ix_(over, part)] *= (most / now[over])[:, None]
    return made
