"""Key shapes by what those before leave unexplained, in one frame and in many."""

import numpy as np

from stages.core import key_shape_candidates, key_weights
from stages.core.key_shape_candidates import Choice


def choose(candidates, count):
    """Take the frame with the largest ``sqrt(|r_j| sum_t max(0, r_t . u_j)^2)``, again and again.

    r_t is what the solve `tolerant_even` leaves of frame t with the shapes taken so far, and
    ``u_j = r_j / |r_j|``. The sum is what a shape along ``u_j`` could explain in all frames, the
    length what it explains in its own: extremes alone chase single frames, the sum alone misses
    what is rare in these frames and common in others.

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
    """
    key_shape_candidates.check(candidates, count)
    chosen = key_shape_candidates.locked_choices(candidates)
    frames, neutral, sigma = candidates.frames, candidates.neutral, candidates.sigma
    while len(chosen) < count:
        shapes = frames[[choice.frame for choice in chosen]]
        weights = key_weights.solve(frames, shapes, neutral, "tolerant_even", sigma).weights
        score = _score(frames - neutral - weights @ (shapes - neutral))
        score[~key_shape_candidates.free(candidates, chosen)] = -1.0
        before = f"the {len(chosen)} before it" if chosen else "the neutral"
        reason = f"holds most of what {before} left unexplained"
        chosen.append(Choice(int(score.argmax()), reason))
    return chosen


def _score(rest):
    """Return how much each residual (T, D) is worth, in its own frame and in the others."""
    length = np.linalg.norm(rest, axis=1)
    towards = rest / np.maximum(length, np.finfo(float).tiny)[:, None]
    # in blocks: a long take has no room for the products of all pairs of frames
    shared = np.zeros(len(rest))
    for part in np.array_split(rest, len(rest) // 512 + 1):
        shared += np.sum(np.maximum(part @ towards.T, 0.0) ** 2, axis=0)
    return np.sqrt(length * shared)
