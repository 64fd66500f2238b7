"""Key shapes at the ends of the principal axes (CB02 section 4.2): the published default."""

import numpy as np

from stages.core import key_shape_candidates, pca
from stages.core.key_shape_candidates import Choice


def choose(candidates, count):
    """Take the frames with the largest and smallest projection on one axis after another.

    A frame that is extreme on two axes is taken once, and the later axis gives its next
    extreme. When only one shape is left to choose, the farther end of the axis is taken.
    A locked frame that is an end of an axis stands for that end.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
    count : int
        Key shapes, locked ones included.

    Returns
    -------
    list of key_shape_candidates.Choice

    Raises
    ------
    ValueError
        When the count cannot be filled.

    Notes
    -----
    CB02 section 4.2.
    """
    key_shape_candidates.check(candidates, count)
    chosen = key_shape_candidates.locked_choices(candidates)
    open_ends = candidates.eligible.copy()
    open_ends[list(candidates.locked)] = True
    scores = pca.project(candidates.model, candidates.frames)
    for number, score in _axes(scores):
        ends = [("largest", _extreme(score, open_ends)), ("smallest", _extreme(-score, open_ends))]
        if count - len(chosen) == 1 and abs(score[ends[1][1]]) > abs(score[ends[0][1]]):
            ends.reverse()
        for which, frame in ends:
            if len(chosen) == count:
                return chosen
            if open_ends[frame] and frame not in candidates.locked:
                chosen.append(Choice(frame, f"{which} along axis {number}"))
            open_ends[frame] = False
    return chosen


def _axes(scores):
    """Yield the number, from 1, and the scores (T,) of every axis, again and again."""
    while True:
        for axis in range(scores.shape[1]):
            yield axis + 1, scores[:, axis]


def _extreme(score, allowed):
    """Return the allowed frame with the largest score."""
    return int(np.argmax(np.where(allowed, score, -np.inf)))
