"""A follower of second order: motion that comes after another's, and swings past it or not.

    y'' = w^2 (x - y) + 2 z w (0 - y'),   w = 2 z / lag

with the damping ratio z: at 1 it arrives as fast as it can without swinging past, below it
overshoots, above it creeps. Of a steady motion it stays `lag` seconds behind. Between frames x runs
straight, and that motion is solved exactly (by the matrix exponential; Van Loan 1978), so the
result does not depend on how many frames tell it.
"""

import numpy as np

from stages.core import resample

TERMS = 18
# a lag that no frame rate shows [s]
LEAST_LAG_S = 1e-5


def follow(values: np.ndarray, rate: float, lag: float, damping: float) -> np.ndarray:
    """Follow curves.

    The follower starts at rest at the first value that is known. Where curves are not known it
    follows the line between their neighbours, and is not known either.

    Parameters
    ----------
    values : (T, K) float array; NaN where not known
    rate : frames per second
    lag : how long it stays behind a steady motion [s]; at 0 it is the curve itself
    damping : the damping ratio, 1 is critical

    Returns
    -------
    (T, K) float array

    Raises
    ------
    ValueError
        if the lag is negative or the damping not above zero
    """
    if not lag >= 0.0 or not damping > 0.0:
        raise ValueError(f"lag {lag} s and damping {damping} are not 0 or more, and above 0")
    if lag < LEAST_LAG_S or not len(values):
        return np.array(values, float)
    keep, drift = step(1.0 / rate, lag, damping)
    known = np.isfinite(values)
    led = np.array(values, float)
    for column, seen in enumerate(known.T):
        if seen.any() and not seen.all():
            led[:, column] = resample.linear(values[seen, column], *resample.neighbours(seen))
    # how far behind, and how fast: both are zero at rest, so what stands still stays to the bit
    state = np.zeros((2, values.shape[1]))
    made = np.empty(values.shape)
    made[0] = led[0]
    for frame in range(1, len(values)):
        slope = (led[frame] - led[frame - 1]) * rate
        state = keep @ state + drift[:, None] * slope
        made[frame] = led[frame] + state[0]
    return np.where(known, made, np.nan)


def step(seconds: float, lag: float, damping: float) -> tuple[np.ndarray, np.ndarray]:
    """Return what a time does to the follower.

    Its state is how far it is ahead of the curve, and its speed.

    Parameters
    ----------
    seconds : the time
    lag, damping : as in `follow`

    Returns
    -------
    keep : (2, 2) float array, what becomes of the state
    drift : (2,) float array, what a curve of slope 1 adds to it
    """
    pace = 2.0 * damping / lag
    # of w times the distance, so that all entries are of one size
    system = pace * np.array([[0.0, 1.0, -1.0], [-1.0, -2.0 * damping, 0.0], [0.0, 0.0, 0.0]])
    moved = _exponential(system * seconds)
    units = np.array([1.0 / pace, 1.0])
    return moved[:2, :2] * units[:, None] / units, moved[:2, 2] * units


def _exponential(matrix: np.ndarray) -> np.ndarray:
    """Return the exponential of a matrix, by its series after halving and squaring."""
    halvings = max(0, int(np.ceil(np.log2(max(np.abs(matrix).sum(axis=1).max(), 1e-300)))) + 1)
    small = matrix / 2.0**halvings
    made = term = np.eye(len(matrix))
    for number in range(1, TERMS):
        term = term @ small / number
        made = made + term
    for _ in range(halvings):
        made = made @ made
    return made
