"""Key shapes by successive projection on lifted coordinates."""

import numpy as np

from stages.core import key_shape_candidates
from stages.core.key_shape_candidates import Choice


def choose(candidates, count):
    """Take the frame farthest from the span of those taken, one after another.

    A coordinate of constant value is added to every frame, so that spans are affine ones.

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
    Araujo et al. 2001; Gillis & Vavasis 2014 for its robustness to noise.
    """
    key_shape_candidates.check(candidates, count)
    chosen = key_shape_candidates.locked_choices(candidates)
    offsets = candidates.frames - candidates.model.mean
    lift = np.linalg.norm(offsets[candidates.eligible], axis=1).max()
    rest = np.hstack([offsets, np.full((len(offsets), 1), lift)])
    for choice in chosen:
        rest = _removed(rest, choice.frame)
    while len(chosen) < count:
        distance = np.sum(rest**2, axis=1)
        distance[~key_shape_candidates.free(candidates, chosen)] = -1.0
        frame = int(distance.argmax())
        chosen.append(Choice(frame, f"farthest from the span of the {len(chosen)} before it"))
        rest = _removed(rest, frame)
    return chosen


def _removed(rest, frame):
    """Return the frames without their component along one of them."""
    length = np.linalg.norm(rest[frame])
    if length == 0:
        return rest
    axis = rest[frame] / length
    return rest - np.outer(rest @ axis, axis)
