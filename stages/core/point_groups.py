"""Which contours of a face belong together: a pupil to its eye, the inner lips to the outer."""

from collections.abc import Sequence

import numpy as np


def nested(contours: Sequence[np.ndarray], shape: np.ndarray) -> list[np.ndarray]:
    """Join every contour to the one that it lies in.

    Parameters
    ----------
    contours : int arrays, the points of each contour
    shape : (P, 2) float array, the mean shape, upright

    Returns
    -------
    int arrays, ascending, which together hold each point of the contours once
    """
    boxes = [(shape[c].min(axis=0), shape[c].max(axis=0)) for c in contours]
    owner = list(range(len(contours)))
    for inner, points in enumerate(contours):
        middle = shape[points].mean(axis=0)
        for outer, (low, high) in enumerate(boxes):
            larger = np.prod(high - low) > np.prod(boxes[inner][1] - boxes[inner][0])
            if outer != inner and larger and ((middle > low) & (middle < high)).all():
                owner[inner] = outer
    while any(owner[owner[c]] != owner[c] for c in range(len(contours))):
        owner = [owner[o] for o in owner]
    return [
        np.sort(np.concatenate([contours[c] for c in range(len(contours)) if owner[c] == o]))
        for o in sorted(set(owner))
    ]
