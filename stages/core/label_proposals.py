"""Which frames are most worth labelling next: doubtful ones, apart in time and in shape."""

import dataclasses

import numpy as np

from stages.core import similarity

APART_S = 0.5
LOST_NEED = 0.8
UNUSUAL_NEED = 0.5
LEAST_NEED = 0.05
FAR = 10.0


@dataclasses.dataclass(frozen=True)
class Tracked:
    """The frames of all shots one after another.

    Attributes
    ----------
    shot : (T,) int array, number of the shot
    time_s : (T,) float array, within the shot [s]
    points : (T, P, 2) float array [px]; NaN where no face was found
    confidence : (T, R) float array, mean confidence of each contour
    residual : (T,) float array, distance of the pixels from the tracker's subspace
    """

    shot: np.ndarray
    time_s: np.ndarray
    points: np.ndarray
    confidence: np.ndarray
    residual: np.ndarray


def unusual(residual: np.ndarray) -> np.ndarray:
    """Return each residual over the median of all, (T,); 1 where there is none."""
    seen = np.isfinite(residual)
    if not seen.any():
        return np.ones(len(residual))
    return np.where(seen, residual / (np.median(residual[seen]) + 1e-12), 1.0)


def need(tracked: Tracked) -> np.ndarray:
    """Return how badly the tracker needs each frame, (T,), from 0.

    It is the doubt about the worst contour plus half of what the pixels' residual is above its
    median (at most once again as large); a frame without a face counts as 0.8.
    """
    doubt = 1 - tracked.confidence.min(axis=1)
    excess = np.clip(unusual(tracked.residual) - 1, 0, 1)
    lost = np.isnan(tracked.points).any(axis=(1, 2))
    return np.where(lost, LOST_NEED, doubt + UNUSUAL_NEED * excess)


def rank(tracked: Tracked, labelled: np.ndarray, count: int) -> list[int]:
    """Choose frames greedily by need, weighed down near labelled and already chosen frames.

    The next frame maximises `n_t (1 - exp(-a^2 / 2)) (1 - exp(-b^2 / 2) / 2)`, with `n_t` the need,
    `a` the time to the nearest such frame of its shot [0.5 s] and `b` the distance of shapes to the
    nearest such frame, in units of the median distance from the mean shape; infinite where no face
    was found. A run of frames without a face is proposed once.

    Parameters
    ----------
    tracked : the frames
    labelled : (T,) bool array, never chosen
    count : greatest number of frames

    Returns
    -------
    indices of the frames, the most useful first

    Raises
    ------
    ValueError
        if the lengths disagree
    """
    if len(labelled) != len(tracked.shot):
        raise ValueError(f"{len(labelled)} labelled flags for {len(tracked.shot)} frames")
    shapes = _comparable(tracked.points)
    wanted = need(tracked)
    runs = _lost_runs(tracked)
    apart = np.full(len(wanted), np.inf)
    unlike = np.full(len(wanted), np.inf)
    chosen: list[int] = []
    fresh = list(np.flatnonzero(labelled))
    while True:
        for t in fresh:
            time = np.abs(tracked.time_s - tracked.time_s[t]) / APART_S
            apart = np.minimum(apart, np.where(tracked.shot == tracked.shot[t], time, np.inf))
            if np.isfinite(shapes[t]).all():
                unlike = np.minimum(unlike, np.sqrt(((shapes - shapes[t]) ** 2).sum(axis=1)))
        distance = np.minimum(np.nan_to_num(unlike, nan=FAR), FAR)
        new = 1 - np.exp(-(distance**2) / 2) / 2
        worth = np.where(labelled, 0, wanted * (1 - np.exp(-(apart**2) / 2)) * new)
        best = int(worth.argmax())
        if len(chosen) == count or worth[best] < LEAST_NEED:
            return chosen
        chosen.append(best)
        wanted[(runs == runs[best]) & (runs >= 0)] = 0
        fresh = [best]


def _lost_runs(tracked: Tracked) -> np.ndarray:
    """Return the number of the run of frames without a face that each is part of, (T,); else -1."""
    lost = np.isnan(tracked.points).any(axis=(1, 2))
    before = np.concatenate([[False], lost[:-1] & (tracked.shot[1:] == tracked.shot[:-1])])
    return np.where(lost, np.cumsum(lost & ~before), -1)


def _comparable(points: np.ndarray) -> np.ndarray:
    """Return aligned shapes (T, 2 P), scaled so that the median distance from their mean is 1."""
    found = np.isfinite(points).all(axis=(1, 2))
    shapes = np.full((len(points), points[0].size), np.nan)
    if found.any():
        mean = similarity.mean_shape(points[found], 1.0, rounds=2)
        aligned = similarity.aligned(points[found], mean).reshape(found.sum(), -1)
        aligned -= aligned.mean(axis=0)
        shapes[found] = aligned / (np.median(np.sqrt((aligned**2).sum(axis=1))) + 1e-12)
    return shapes
