"""Key shapes by equation 5 itself: greedy, then exchanges, with non-negative weights."""

import numpy as np

from stages.core import key_shape_candidates, key_weights
from stages.core.key_shape_candidates import Choice

_MEASURED = 100


def choose(candidates, count):
    """Lower ``sum_t min_(w >= 0) |x_t - n - sum_i w_i d_i|^2``, d_i the offsets of key shapes.

    A frame is proposed by what it would save if its weight alone were added to the others'
    solution, ``sum_t max(0, r_t . d_j)^2 / |d_j|^2``; an exchange is kept when the exact solve
    of all weights finds it better, and each key shape is put to the test once. At most 100
    frames, evenly spread, are measured; all are candidates.

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

    Notes
    -----
    CB02 equation 5.
    """
    key_shape_candidates.check(candidates, count)
    offsets = candidates.frames - candidates.neutral
    measured = offsets[:: -(-len(offsets) // _MEASURED)]
    rows = list(candidates.locked)
    rest = _residuals(measured, offsets[rows])
    while len(rows) < count:
        rows.append(_proposed(offsets, rest, rows, candidates.eligible))
        rest = _residuals(measured, offsets[rows])
    cost = np.sum(rest**2)
    for place in range(len(candidates.locked), count):
        others = rows[:place] + rows[place + 1 :]
        rest = _residuals(measured, offsets[others])
        trial = list(rows)
        trial[place] = _proposed(offsets, rest, others, candidates.eligible)
        new_cost = np.sum(_residuals(measured, offsets[trial]) ** 2)
        if new_cost < cost:
            rows, cost = trial, new_cost
    reason = f"one of {count} that together leave the smallest error found"
    chosen = [Choice(int(row), reason) for row in rows[len(candidates.locked) :]]
    return key_shape_candidates.locked_choices(candidates) + chosen


def _residuals(measured, shapes):
    """Return what non-negative weights of the shapes leave of every frame (T, D)."""
    nothing = np.zeros(measured.shape[1])
    solution = key_weights.solve(measured, shapes, nothing, "nonnegative_offset")
    return measured - solution.weights @ shapes


def _proposed(offsets, rest, rows, eligible):
    """Return the free frame whose weight alone would save most of the residuals."""
    square = np.maximum(np.sum(offsets**2, axis=1), np.finfo(float).tiny)
    saved = np.sum(np.maximum(rest @ offsets.T, 0.0) ** 2, axis=0) / square
    allowed = eligible.copy()
    allowed[rows] = False
    return int(np.argmax(np.where(allowed, saved, -1.0)))
