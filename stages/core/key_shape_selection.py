"""Selectors of key shapes by name."""

from functools import partial

from stages.core import (
    clustering,
    convex_hull,
    farthest_residual,
    maximum_spread,
    successive_projection,
)

FIXED_BY_DATA = "convex_hull"
SELECTORS = {
    "maximum_spread": maximum_spread.choose,
    "clustering_2d": partial(clustering.choose, dimensions=2),
    "clustering_3d": partial(clustering.choose, dimensions=3),
    "successive_projection": successive_projection.choose,
    "farthest_residual": farthest_residual.choose,
}
# the first shapes of a larger choice are the choice of fewer
NESTED = ("successive_projection", "farthest_residual")
NAMES = (*SELECTORS, FIXED_BY_DATA)


def choose(candidates, count, method):
    """Choose key shapes by one of `SELECTORS`, or all corners of the convex hull.

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
    if method == FIXED_BY_DATA:
        return convex_hull.choose(candidates)
    if method not in SELECTORS:
        raise ValueError(f"no selector is called '{method}': choose one of {', '.join(NAMES)}")
    return SELECTORS[method](candidates, count)
