"""Curves without their jitter: a smoothing spline whose strength the motion itself decides.

A curve is a smooth level with jitter on it, and its slope wanders (Wahba 1978; as a state-space
model Kohn & Ansley 1987; Shumway & Stoffer 1982 for the smoother):

    d level = slope dt,  d slope = sqrt(q) dW,  x_t = level + v,  v ~ N(0, r),

discretised exactly, so that q / r does not depend on the frame rate. Of several q / r that of the
greatest likelihood is taken, curve by curve: the one whose prediction of each next frame from those
before is best. The Kalman smoother then gives the level without delay.
"""

from collections.abc import Sequence

import numpy as np

# q / r [1 / s^3]; at 30 frames/s they pass 1 to 37 Hz
RATIOS = 10.0 ** np.arange(2.0, 8.5, 0.5)
# what other takes have shown counts as so much of the take itself [s]
PRIOR_S = 3.0
# curves that are filtered at once, and frames that tell a ratio
COLUMNS, MOST_FRAMES = 256, 6000
# beyond either end the curve goes on, turned about its last value [s]
MARGIN_S = 1.0
ROUNDS = 10_000


def errors(values: np.ndarray, rate: float) -> np.ndarray:
    """Return how badly each ratio foretells a take's frames.

    Parameters
    ----------
    values : (T, K) float array, finite
    rate : frames per second

    Returns
    -------
    (R, K) float array, mean square [unit squared]
    """
    padded, _ = _padded(values[:MOST_FRAMES], rate)
    made = np.empty((len(RATIOS), values.shape[1]))
    for first in range(0, values.shape[1], COLUMNS):
        part = slice(first, first + COLUMNS)
        for number, ratio in enumerate(RATIOS):
            some = padded[:, part]
            *_, wrong = _forward(some, rate, np.full(some.shape[1], ratio))
            made[number, part] = np.mean(wrong**2, axis=0)
    return made


def learn(takes: Sequence[np.ndarray], rates: Sequence[float]) -> np.ndarray:
    """Return the errors (R, K) over several takes (T, K) of some rates."""
    seconds = np.array([len(take) / rate for take, rate in zip(takes, rates, strict=True)])
    each = [errors(take, rate) for take, rate in zip(takes, rates, strict=True)]
    return np.tensordot(seconds / seconds.sum(), np.stack(each), 1)


def smooth(values: np.ndarray, rate: float, learnt: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """Take the jitter out of curves.

    Parameters
    ----------
    values : (T, K) float array, finite
    rate : frames per second
    learnt : (R, K) float array, what `learn` made of other takes
    factor : (K,) float array, by how much more jitter is suspected; 0 leaves a curve alone

    Returns
    -------
    (T, K) float array

    Raises
    ------
    ValueError
        if the shapes do not fit or a value is not finite
    """
    wanted = (len(RATIOS), *values.shape[1:])
    if values.ndim != 2 or learnt.shape != wanted or factor.shape != values.shape[1:]:
        shapes = f"values {values.shape}, learnt {learnt.shape}, factor {factor.shape}"
        raise ValueError(f"{shapes} do not belong together")
    if not np.isfinite(values).all():
        raise ValueError(f"values {values.shape} are not all finite")
    moved = np.flatnonzero(factor > 0.0)
    made = np.array(values, float)
    if not len(moved) or len(values) < 2:
        return made
    some = values[:, moved]
    tiny = np.finfo(float).tiny
    own = np.log(errors(some, rate) + tiny)
    before = np.log(learnt[:, moved] + tiny)
    score = len(values) / rate * own + PRIOR_S * before
    ratios = RATIOS[np.argmin(score, axis=0)] / factor[moved]
    for first in range(0, len(moved), COLUMNS):
        part = slice(first, first + COLUMNS)
        made[:, moved[part]] = _smoothed(some[:, part], rate, ratios[part])
    return made


def _smoothed(values: np.ndarray, rate: float, ratios: np.ndarray) -> np.ndarray:
    """Return the level of every curve, with a ratio for each."""
    padded, margin = _padded(values, rate)
    ahead, here, back, _ = _forward(padded, rate, ratios)
    level = np.empty(padded.shape)
    state = here[-1]
    level[-1] = state[0]
    for t in range(len(padded) - 2, -1, -1):
        state = here[t] + np.einsum("ijk,jk->ik", back, state - ahead[t + 1])
        level[t] = state[0]
    return level[margin : margin + len(values)]


def _forward(
    values: np.ndarray, rate: float, ratios: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Filter curves (T, K): predicted and filtered states (T, 2, K), gains back, what was wrong."""
    step = _step(rate)
    every, owner = np.unique(ratios, return_inverse=True)
    gains = [_gains(ratio, rate) for ratio in every]
    gain = np.stack([one for one, _ in gains], axis=1)[:, owner]
    back = np.stack([one for _, one in gains], axis=2)[:, :, owner]
    ahead = np.empty((len(values), 2, values.shape[1]))
    here, wrong = np.empty_like(ahead), np.empty(values.shape)
    state = np.stack([values[0], np.zeros(values.shape[1])])
    for t, row in enumerate(values):
        state = step @ state if t else state
        ahead[t] = state
        wrong[t] = row - state[0]
        state = state + gain * wrong[t]
        here[t] = state
    return ahead, here, back, wrong


def _step(rate: float) -> np.ndarray:
    """Return what a frame makes of level and slope."""
    return np.array([[1.0, 1.0 / rate], [0.0, 1.0]])


def _gains(ratio: float, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the settled gains of filter (2,) and smoother (2, 2) for a variance of jitter of 1."""
    step, frame_s = _step(rate), 1.0 / rate
    drive = ratio * np.array([[frame_s**3 / 3, frame_s**2 / 2], [frame_s**2 / 2, frame_s]])
    spread = drive + np.diag([1.0, ratio * frame_s])
    for _ in range(ROUNDS):
        gain = spread[:, 0] / (spread[0, 0] + 1.0)
        after = spread - np.outer(gain, spread[0])
        ahead = step @ after @ step.T + drive
        settled = np.abs(ahead - spread).max() <= 1e-12 * np.abs(ahead).max()
        spread = ahead
        if settled:
            break
    return gain, np.linalg.solve(ahead, step @ after).T


def _padded(values: np.ndarray, rate: float) -> tuple[np.ndarray, int]:
    """Return curves that go on beyond both ends, and by how many frames."""
    margin = min(round(MARGIN_S * rate), len(values) - 1)
    before = 2.0 * values[0] - values[margin:0:-1]
    after = 2.0 * values[-1] - values[-2 : -2 - margin : -1]
    return np.concatenate([before, values, after]), margin
