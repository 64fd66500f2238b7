"""Bring coordinates of several kinds, in space and in the picture, into one vector.

Two numbers in unlike units must not be added. Each group of coordinates, markers (3-D) or points
of a film (2-D), is a block of the extremes `B`; `m_g` is the mean over the extremes of the squared
length of that block. Coordinates of group g are multiplied by

- `variance`: `1 / sqrt(m_g G)`, with G groups, so that each kind says equally much;
- `published`: `1 / sqrt(sum_g m_g)`, the same for all: the groups stay in face units as they are,
  joined end to end (K11 section 4), and the kind with more points or larger motion says more.

In both the mean squared length of a balanced extreme is 1: a face that stands still where the
actor shows a mean extreme costs a data term of 1. So the strengths of the biases mean the same for
every actor and unit, and multiplying all coordinates by 100 changes nothing.
"""

import numpy as np

RULES = ("variance", "published")


def factors(basis: np.ndarray, group: np.ndarray, rule: str) -> np.ndarray:
    """Return the factor of every coordinate.

    Parameters
    ----------
    basis : (D, K) float array, extremes less the neutral
    group : (D,) int array, the group of each coordinate, from 0
    rule : `variance` or `published`

    Returns
    -------
    (D,) float array

    Raises
    ------
    ValueError
        if shapes differ, the rule is unknown, or a group never moves
    """
    if rule not in RULES or np.shape(group) != basis.shape[:1]:
        shapes = f"basis {basis.shape} and group {np.shape(group)}"
        raise ValueError(f"no rule '{rule}' of {', '.join(RULES)} for {shapes}")
    squares = np.bincount(group, np.sum(basis**2, axis=1)) / basis.shape[1]
    if not (squares > 0).all():
        still = np.flatnonzero(~(squares > 0)).tolist()
        raise ValueError(f"groups {still} are the same in every extreme")
    if rule == "published":
        return np.full(len(basis), 1 / np.sqrt(squares.sum()))
    return 1 / np.sqrt(squares * len(squares))[group]
