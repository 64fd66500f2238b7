"""Key shapes at the corners of the convex hull on two axes (CB02 section 4.2)."""

import numpy as np

from stages.core import key_shape_candidates, pca
from stages.core.key_shape_candidates import Choice


def choose(candidates, count):
    """Take every eligible frame at a corner of the hull on the first two principal axes.

    The frames fix how many there are, whatever `count` says. Locked frames come first and are
    not taken twice.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
    count : int
        Not used; every selector takes one.

    Returns
    -------
    list of key_shape_candidates.Choice
        In counterclockwise order from the smallest coordinate on axis 1.

    Raises
    ------
    ValueError
        When no frame is eligible.

    Notes
    -----
    CB02 section 4.2. In more than two dimensions nearly every frame is a corner.
    """
    del count
    key_shape_candidates.check(candidates, max(1, len(candidates.locked)))
    chosen = key_shape_candidates.locked_choices(candidates)
    usable = np.flatnonzero(candidates.eligible)
    points = pca.project(candidates.model, candidates.frames[usable])[:, :2]
    if points.shape[1] < 2:
        points = np.hstack([points, np.zeros((len(points), 2 - points.shape[1]))])
    for corner in _corners(points):
        if usable[corner] not in candidates.locked:
            chosen.append(Choice(int(usable[corner]), "corner of the convex hull on 2 axes"))
    return chosen


def _corners(points):
    """Return the indices of the hull's corners by Andrew's monotone chain."""
    order = np.lexsort((points[:, 1], points[:, 0]))
    if len(order) < 3:
        return order
    lower, upper = _chain(points, order), _chain(points, order[::-1])
    return list(dict.fromkeys(lower[:-1] + upper[:-1]))


def _chain(points, order):
    """Return the indices along one side of the hull."""
    chain = []
    for index in order:
        while len(chain) > 1 and _turn(points, chain[-2], chain[-1], index) <= 0:
            chain.pop()
        chain.append(index)
    return chain


def _turn(points, first, second, third):
    """Return twice the signed area of a triangle: positive when it turns left."""
    a, b = points[second] - points[first], points[third] - points[first]
    return a[0] * b[1] - a[1] * b[0]
