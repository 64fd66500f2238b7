"""Some parts of a whole come after, and the others keep their times.

Under a mask, speech and blinks take what they need, `s`, of a whole of one; emotion has the rest.
So what follows is the emotion in proportion to the room that is left, `e / (1 - s)`, and the result
is given that room again: where speech closes the lips, nothing that lingers opens them.
"""

import numpy as np

from stages.core import follower, resample

# with less room than this the proportion says nothing, and is taken from before and after
LEAST_ROOM = 0.2


def follow(
    values: np.ndarray,
    followed: np.ndarray,
    whole: np.ndarray,
    rate: float,
    lag: float,
    damping: float,
) -> np.ndarray:
    """Follow some of the curves of each whole.

    Parameters
    ----------
    values : (T, K) float array; NaN where not known
    followed : (K,) bool array, the curves that come after
    whole : (K,) int array, of which whole each curve is a part
    rate : frames per second
    lag, damping : as in `follower.follow`

    Returns
    -------
    (T, K) float array; a curve that does not follow comes back as it is
    """
    made = np.array(values, float)
    if lag == 0.0:
        return made
    for number in np.unique(whole[followed]):
        own = np.flatnonzero((whole == number) & followed)
        taken = values[:, (whole == number) & ~followed].sum(axis=1)
        room = np.maximum(1.0 - taken, 0.0)
        known = np.isfinite(values[:, own]).all(axis=1) & (room >= LEAST_ROOM)
        if not known.any():
            continue
        parts = values[known][:, own] / room[known, None]
        filled = resample.linear(parts, *resample.neighbours(known))
        after = follower.follow(filled, rate, lag, damping) * room[:, None]
        made[:, own] = np.where(np.isfinite(values[:, own]), after, np.nan)
    return made
