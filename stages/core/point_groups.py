"""Which points of a face belong together: a pupil to its eye, the inner lips to the outer."""

from collections.abc import Sequence

import numpy as np


def nested(owners: Sequence[str], shape: np.ndarray) -> list[np.ndarray]:
    """Join the points of every contour to those of the one that it lies in.

    Parameters
    ----------
    owners : for each of the P points, the contour that it belongs to
    shape : (P, 2) float array, the mean shape, upright

    Returns
    -------
    int arrays, each ascending, which together hold each point once

    Raises
    ------
    ValueError
        if the lengths differ
    """
    if len(owners) != len(shape):
        raise ValueError(f"{len(owners)} owners for {len(shape)} points")
    contours = [
        np.flatnonzero([owner == name for owner in owners]) for name in dict.fromkeys(owners)
    ]
    contours.sort(key=lambda points: (-np.prod(np.ptp(shape[points], axis=0)), points[0]))
    groups: list[list[np.ndarray]] = []
    for points in contours:
        middle = shape[points].mean(axis=0)
        for group in groups:
            box = shape[group[0]]
            if ((middle > box.min(axis=0)) & (middle < box.max(axis=0))).all():
                group.append(points)
                break
        else:
            groups.append([points])
    joined = [np.sort(np.concatenate(group)) for group in groups]
    return sorted(joined, key=lambda points: points[0])
