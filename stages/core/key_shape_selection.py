"""Selectors of key shapes by name."""

from functools import partial

import numpy as np

from stages.core import (
    clustering,
    convex_hull,
    expected_error,
    farthest_residual,
    maximum_spread,
    shared_residual,
    successive_projection,
    swap_refinement,
)

FIXED_BY_DATA = "convex_hull"
# the first shapes of a larger choice are the choice of fewer
NESTED = ("successive_projection", "farthest_residual", "shared_residual")
SELECTORS = {
    "maximum_spread": maximum_spread.choose,
    "clustering_2d": partial(clustering.choose, dimensions=2),
    "clustering_3d": partial(clustering.choose, dimensions=3),
    FIXED_BY_DATA: convex_hull.choose,
    "successive_projection": successive_projection.choose,
    "farthest_residual": farthest_residual.choose,
    "shared_residual": shared_residual.choose,
    "swap_refinement": swap_refinement.choose,
    "expected_error": expected_error.choose,
}


def choose(candidates, count, method):
    """Choose key shapes by one of `SELECTORS`.

    A selector sees the eligible and the locked frames only, so what was tracked badly neither
    becomes a key shape nor pulls on the choice.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
    count : int
        Key shapes, locked ones included; `convex_hull` fixes its own.
    method : str

    Returns
    -------
    list of key_shape_candidates.Choice

    Raises
    ------
    ValueError
        When the count cannot be filled, or the name is unknown.
    """
    if method not in SELECTORS:
        raise ValueError(f"no selector is called '{method}': choose one of {', '.join(SELECTORS)}")
    usable = candidates.eligible.copy()
    usable[list(candidates.locked)] = True
    rows = np.flatnonzero(usable)
    seen = candidates._replace(
        frames=candidates.frames[rows],
        eligible=candidates.eligible[rows],
        locked=tuple(int(row) for row in np.searchsorted(rows, candidates.locked)),
    )
    choices = SELECTORS[method](seen, count)
    return [choice._replace(frame=int(rows[choice.frame])) for choice in choices]
