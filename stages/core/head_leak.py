"""How much of the face's own motion was taken for the head's."""

import numpy as np

MIN_FRAMES = 10


def strongest_motion(points: np.ndarray) -> np.ndarray:
    """Return the score (T,) of the first principal axis of (T, D) points: the jaw, as a rule.

    An unknown coordinate counts as its mean over the clip, so that single markers may be missing;
    frames with fewer than half of the coordinates get NaN.
    """
    known = np.isfinite(points)
    enough = 2 * known.sum(axis=1) >= points.shape[1]
    score = np.full(len(points), np.nan)
    if enough.any():
        counts = np.maximum(known[enough].sum(axis=0), 1)
        mean = np.where(known[enough], points[enough], 0.0).sum(axis=0) / counts
        centred = np.where(known[enough], points[enough] - mean, 0.0)
        score[enough] = centred @ np.linalg.eigh(centred.T @ centred)[1][:, -1]
    return score


def head_leak(motion: np.ndarray, opening: np.ndarray, window: int) -> float:
    """Return the multiple correlation of the head motion with the jaw's opening.

    `R` of the linear regression of the opening on the motion's parameters, each with its running
    mean taken out: a head that nods slowly while its owner talks is no leak, a head that jumps
    with each syllable is.

    Parameters
    ----------
    motion : (T, M) float array, parameters of the head motion; NaN where unknown
    opening : (T,) float array, opening of the jaw; NaN where unknown
    window : frames of the running mean, about a second

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
    known = np.isfinite(motion).all(axis=1) & np.isfinite(opening)
    if known.sum() < MIN_FRAMES:
        return float("nan")
    quick = _without_running_mean(np.column_stack([motion, opening])[known], window)
    parameters, change = quick[:, :-1], quick[:, -1]
    if np.ptp(change) == 0:
        return 0.0
    fitted = parameters @ np.linalg.lstsq(parameters, change, rcond=None)[0]
    return float(np.sqrt(np.clip((fitted @ change) / (change @ change), 0, 1)))


def _without_running_mean(values: np.ndarray, window: int) -> np.ndarray:
    """Return (T, N) values less their mean over a window round each frame, shorter at the ends."""
    sums = np.vstack([np.zeros(values.shape[1]), np.cumsum(values, axis=0)])
    frame = np.arange(len(values))
    start = np.maximum(frame - window // 2, 0)
    end = np.minimum(frame + window // 2 + 1, len(values))
    return values - (sums[end] - sums[start]) / (end - start)[:, None]
