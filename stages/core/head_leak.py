"""How much of the jaw's motion was taken for the head's."""

import numpy as np

MIN_FRAMES = 10


def head_leak(motion: np.ndarray, opening: np.ndarray) -> float:
    """Return the multiple correlation of the head motion with the jaw's opening.

    `R` of the linear regression of the opening on the motion's parameters, with slow drifts taken
    out by differences between frames: a head that nods while its owner talks is no leak, a head
    that jumps with each syllable is.

    Parameters
    ----------
    motion : (T, M) float array, parameters of the head motion; NaN where unknown
    opening : (T,) float array, distance of the lips; NaN where unknown

    Returns
    -------
    float between 0 (none) and 1; NaN with fewer than ten usable frames

    Raises
    ------
    ValueError
        if the lengths differ
    """
    if motion.ndim != 2 or len(motion) != len(opening):
        raise ValueError(f"expected (T, M) and (T,), got {motion.shape} and {opening.shape}")
    steps, change = np.diff(motion, axis=0), np.diff(opening)
    known = np.isfinite(steps).all(axis=1) & np.isfinite(change)
    if known.sum() < MIN_FRAMES:
        return float("nan")
    steps, change = steps[known] - steps[known].mean(axis=0), change[known] - change[known].mean()
    if not change.any():
        return 0.0
    fitted = steps @ np.linalg.lstsq(steps, change, rcond=None)[0]
    return float(np.sqrt(np.clip((fitted @ change) / (change @ change), 0, 1)))
