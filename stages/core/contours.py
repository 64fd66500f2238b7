"""Labelled contours, resampled evenly along each stretch between corners (CB02 section 3)."""

from collections.abc import Sequence

import numpy as np


def resample(points: np.ndarray, closed: bool, corners: Sequence[int], count: int) -> np.ndarray:
    """Distribute points evenly along a contour, keeping its corners.

    Each stretch between two corners gets the same number of intervals on every frame (the first
    stretches get one more where the count does not divide), so that a point keeps its meaning
    when one stretch grows. The ends of an open contour are corners.

    Parameters
    ----------
    points : (N, 2) float array [px], in order along the contour
    closed : whether the last point joins the first
    corners : indices of the corners, ascending
    count : number of points wanted

    Returns
    -------
    (count, 2) float array [px]; a closed contour starts at its first corner

    Raises
    ------
    ValueError
        if there are fewer intervals than stretches, or a closed contour has no corner
    """
    if closed:
        if not corners:
            raise ValueError(f"a closed contour of {len(points)} points needs a corner")
        path = np.roll(points, -corners[0], axis=0)
        path = np.concatenate([path, path[:1]])
        ends = [corner - corners[0] for corner in corners] + [len(points)]
        intervals = count
    else:
        path = points
        ends = sorted({0, *corners, len(points) - 1})
        intervals = count - 1
    stretches = len(ends) - 1
    if intervals < stretches:
        raise ValueError(f"{count} points cannot keep {stretches} stretches between corners")
    shares = [intervals // stretches + (s < intervals % stretches) for s in range(stretches)]
    pieces = [
        _even(path[first : last + 1], share)
        for first, last, share in zip(ends[:-1], ends[1:], shares, strict=True)
    ]
    joined = np.concatenate(pieces)
    return joined if closed else np.concatenate([joined, path[-1:]])


def _even(path: np.ndarray, intervals: int) -> np.ndarray:
    """Return the starts of equal intervals of arc length along a path (N, 2)."""
    lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    wanted = along[-1] * np.arange(intervals) / intervals
    return np.stack([np.interp(wanted, along, path[:, axis]) for axis in range(2)], axis=1)
