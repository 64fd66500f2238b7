"""Bring coordinates of several kinds, in space and in the picture, into one vector.

Two numbers in unlike units must not be added. Groups of coordinates are markers (3-D) and points of
a film (2-D); `s_d` is the mean over the extremes of the squared coordinate d. The square of a
coordinate's factor is proportional to

- `published`: 1, the same for all: the groups stay in face units as they are, joined end to end
  (K11 section 4), and the kind with more points or larger motion says more;
- `variance`: `1 / sum_g s`, with the sum over its group: each kind says equally much;
- `mask_variance`: `sum_l M_l / sum_gl s`, with the sum over its group under the mask l: each kind
  under each mask says equally much. Lids move little; under the other rules a temporal bias that
  suits a mouth smooths their blinks away. A part whose coordinates move less than a tenth of their
  group's counts as if they moved that much, so that noise is not taken for motion.

In all, the mean squared length of a balanced extreme is 1: a face that stands still where the actor
shows a mean extreme costs a data term of 1. So the strengths of the biases mean the same for every
actor and unit, and multiplying all coordinates by 100 changes nothing.
"""

import numpy as np

RULES = ("mask_variance", "variance", "published")
LEAST = 0.01  # of its group's mean square, that a part under a mask counts as having


def factors(basis: np.ndarray, group: np.ndarray, masks: np.ndarray, rule: str) -> np.ndarray:
    """Return the factor of every coordinate.

    Parameters
    ----------
    basis : (D, K) float array, extremes less the neutral
    group : (D,) int array, the group of each coordinate, from 0
    masks : (R, D) float array, one in sum at every coordinate; `mask_variance` looks at them
    rule : one of `RULES`

    Returns
    -------
    (D,) float array

    Raises
    ------
    ValueError
        if shapes differ, the rule is unknown, or a group never moves
    """
    if rule not in RULES or {np.shape(group), masks.shape[1:]} != {basis.shape[:1]}:
        shapes = f"basis {basis.shape}, group {np.shape(group)} and masks {masks.shape}"
        raise ValueError(f"no rule '{rule}' of {', '.join(RULES)} for {shapes}")
    squares = np.mean(basis**2, axis=1)
    totals, counts = np.bincount(group, squares), np.bincount(group)
    if not (totals > 0).all():
        still = np.flatnonzero(~(totals > 0)).tolist()
        raise ValueError(f"groups {still} are the same in every extreme")
    if rule == "published":
        share = np.ones(len(basis))
    elif rule == "variance":
        share = 1 / totals[group]
    else:
        share = np.zeros(len(basis))
        for mask in masks:
            size = np.bincount(group, mask)
            moved = np.maximum(np.bincount(group, mask * squares), LEAST * size * totals / counts)
            share += mask / np.where(moved > 0, moved, 1.0)[group]
    return np.sqrt(share / (share @ squares))
