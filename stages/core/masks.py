"""Masks over a character's vertices: which region moves a vertex, and how much of it.

Masks are a partition of unity: at every vertex they sum to one.
"""

from collections.abc import Sequence

import numpy as np

TOLERANCE = 1e-4


def ramp(heights: np.ndarray, start: float, end: float) -> np.ndarray:
    """Rise linearly from 0 at `start` to 1 at `end`, whichever is the greater (CB02, section 5).

    Parameters
    ----------
    heights : (V,) float array, the vertices' coordinate along the ramp's axis
    start, end : the two heights, in the same unit

    Returns
    -------
    (V,) float array in 0..1

    Raises
    ------
    ValueError
        if the two heights are the same
    """
    if start == end:
        raise ValueError(f"a ramp from {start} to {end} has no length")
    return np.clip((heights - start) / (end - start), 0.0, 1.0)


def layer(masks: np.ndarray, region: int, share: np.ndarray) -> np.ndarray:
    """Give a region its share at every vertex and leave the others what remains, in proportion.

    Parameters
    ----------
    masks : (R, V) float array, a partition of unity
    region : row that takes
    share : (V,) float array in 0..1

    Returns
    -------
    (R, V) float array, again a partition of unity
    """
    result = masks * (1.0 - share)
    result[region] += share
    return result


def by_ramps(
    coordinates: np.ndarray,
    count: int,
    rest: int,
    ramps: Sequence[tuple[int, int, float, float]],
    listed: Sequence[tuple[int, Sequence[int]]],
) -> np.ndarray:
    """Make masks from ramps, each taking its share of what stood before, then listed vertices.

    Parameters
    ----------
    coordinates : (V, D) float array of the neutral
    count : R
    rest : the region that has everything to begin with
    ramps : (region, axis, start, end) of each ramp
    listed : (region, vertices) that a region takes wholly

    Returns
    -------
    (R, V) float array, a partition of unity
    """
    masks = np.zeros((count, len(coordinates)))
    masks[rest] = 1.0
    for region, axis, start, end in ramps:
        masks = layer(masks, region, ramp(coordinates[:, axis], start, end))
    for region, vertices in listed:
        share = np.zeros(len(coordinates))
        share[list(vertices)] = 1.0
        masks = layer(masks, region, share)
    return masks


def first_fault(masks: np.ndarray) -> tuple[int, str] | None:
    """Return the first vertex where masks are negative or do not sum to one, and what they are.

    Parameters
    ----------
    masks : (R, V) float array

    Returns
    -------
    (vertex, what was found), or None for a partition of unity
    """
    total = masks.sum(axis=0)
    bad = np.flatnonzero((np.abs(total - 1.0) > TOLERANCE) | (masks < 0).any(axis=0))
    if not len(bad):
        return None
    vertex = int(bad[0])
    if (masks[:, vertex] < 0).any():
        return vertex, f"a weight is {masks[:, vertex].min():g}, below zero"
    return vertex, f"the weights sum to {total[vertex]:g} in place of 1"


def normalised(masks: np.ndarray) -> np.ndarray:
    """Divide out the rounding of hand-written tables, so that the sum is one to the last bit."""
    return masks / masks.sum(axis=0)
