"""Key shapes by the largest residual of the non-negative solve."""

import numpy as np

from stages.core import key_shape_candidates, key_weights
from stages.core.key_shape_candidates import Choice


def choose(candidates, count):
    """Take the frame that non-negative weights of those taken explain worst, again and again.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
    count : int
        Key shapes, locked ones included.

    Returns
    -------
    list of key_shape_candidates.Choice
        The first is the frame farthest from the neutral.

    Raises
    ------
    ValueError
        When the count cannot be filled.
    """
    key_shape_candidates.check(candidates, count)
    chosen = key_shape_candidates.locked_choices(candidates)
    frames, neutral = candidates.frames, candidates.neutral
    while len(chosen) < count:
        residual = np.linalg.norm(frames - neutral, axis=1)
        if chosen:
            shapes = frames[[choice.frame for choice in chosen]]
            residual = key_weights.solve(frames, shapes, neutral, "nonnegative_offset").residual
        residual = np.where(key_shape_candidates.free(candidates, chosen), residual, -1.0)
        reason = (
            f"worst explained by the {len(chosen)} before it"
            if chosen
            else ("farthest from the neutral")
        )
        chosen.append(Choice(int(residual.argmax()), reason))
    return chosen
