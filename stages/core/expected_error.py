"""Key shapes that leave the smallest error expected in the target: greedy, then swaps."""

import numpy as np

from stages.core import key_shape_candidates, key_weights
from stages.core.key_shape_candidates import Choice

_ROUNDS = 6
_BETTER = 1 + 1e-9
# keeps a set with dependent frames solvable
_TIE_BREAK = 1e-9


def choose(candidates, count):
    """Minimise ``tr(C^(1/2) (I - D' (D D' + P)^-1 D))`` over sets of frames with offsets D.

    P is the tolerance of `key_weights.tolerant_even`. With C the second moment of all offsets
    in place of its square root this is CB02's equation 5 plus the error that flawed sculpts add
    to it, ``sum_t min_w |x_t - n - sum_i w_i d_i|^2 + tolerance(w)``. The root lets rare
    expressions count for more than they do on average, because new footage holds others still.
    No weights are needed, so every frame can be tried in every place: frames are added one by
    one, each the best there is, then exchanged until no exchange helps. Weights may be of
    either sign; for non-negative ones choose another method.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
    count : int
        Key shapes, locked ones included; those are never exchanged.

    Returns
    -------
    list of key_shape_candidates.Choice

    Raises
    ------
    ValueError
        When the count cannot be filled.
    """
    key_shape_candidates.check(candidates, count)
    sigma = candidates.sigma
    offsets = candidates.frames - candidates.neutral
    root = _root_of_moment(offsets)
    rows = list(candidates.locked)
    while len(rows) < count:
        rows.append(_best(offsets, root, rows, sigma, candidates.eligible)[0])
    for _ in range(_ROUNDS):
        before = list(rows)
        for place in range(len(candidates.locked), count):
            rest = rows[:place] + rows[place + 1 :]
            frame, gains = _best(offsets, root, rest, sigma, candidates.eligible)
            if gains[frame] > gains[rows[place]] * _BETTER:
                rows[place] = frame
        if rows == before:
            break
    return key_shape_candidates.locked_choices(candidates) + _ordered(
        offsets, root, rows, len(candidates.locked), sigma
    )


def _ordered(offsets, root, rows, locked, sigma):
    """Return the choices, each the most useful one after those before it."""
    chosen, left = rows[:locked], list(rows[locked:])
    choices = []
    while left:
        gains = _gains(offsets, root, chosen, sigma)
        frame = max(left, key=gains.__getitem__)
        chosen.append(frame)
        left.remove(frame)
        choices.append(Choice(frame, f"saves most error beside the {len(chosen) - 1} before it"))
    return choices


def _best(offsets, root, rows, sigma, eligible):
    """Return the free frame that saves most beside those in `rows`, and what each frame saves."""
    gains = _gains(offsets, root, rows, sigma)
    allowed = eligible.copy()
    allowed[rows] = False
    return int(np.argmax(np.where(allowed, gains, -1.0))), gains


def _gains(offsets, root, rows, sigma):
    """Return by how much (T,) each frame would lower the expected error beside those in `rows`."""
    square = np.sum(offsets**2, axis=1)
    own, shared = key_weights.even_errors(square, sigma)
    own = own + _TIE_BREAK * square + np.finfo(float).tiny
    left, variance = offsets, square + shared + own
    if len(rows):
        cross = offsets[rows] @ offsets.T + shared
        part = np.linalg.solve(cross[:, rows] + np.diag(own[rows]), cross)
        left, variance = offsets - part.T @ offsets[rows], variance - np.sum(cross * part, axis=0)
    return np.sum((left @ root) * left, axis=1) / np.maximum(variance, own)


def _root_of_moment(offsets):
    """Return the square root (D, D) of the second moment of the offsets."""
    values, axes = np.linalg.eigh(offsets.T @ offsets)
    return (axes * np.sqrt(np.maximum(values, 0.0))) @ axes.T
