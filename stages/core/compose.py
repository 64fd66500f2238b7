"""The one contract for what moves: neutral plus masked, weighted shape differences.

    x(v, t) = H_t [ N(v) + sum_l M_l(v) sum_i u_li(t) (B_i(v) - N(v)) ]

The part in brackets is here; the head motion `H_t` is in `head_transform`.
"""

import itertools
from typing import NamedTuple

import numpy as np

from stages.core import local_shapes

BLOCK = 256


class Block(NamedTuple):
    """Hold a run of vertices, the shapes that reach it and what they do there.

    Attributes
    ----------
    start, stop : the run
    shapes : (k,) int array
    deltas : (k, (stop - start) D) float array [character's unit]
    """

    start: int
    stop: int
    shapes: np.ndarray
    deltas: np.ndarray


def blocks(shapes: local_shapes.LocalShapes) -> list[Block]:
    """Cut masked shapes into small dense products that leave out what is zero.

    Parameters
    ----------
    shapes : K shapes from `local_shapes.masked`
    """
    owner = np.repeat(np.arange(len(shapes.first) - 1), np.diff(shapes.first))
    order = np.argsort(shapes.vertices // BLOCK, kind="stable")
    bounds = np.searchsorted(
        shapes.vertices[order] // BLOCK, np.arange(-(-shapes.count // BLOCK) + 1)
    )
    made = []
    for number, (low, high) in enumerate(itertools.pairwise(bounds)):
        start, stop = number * BLOCK, min((number + 1) * BLOCK, shapes.count)
        rows = order[low:high]
        used, place = np.unique(owner[rows], return_inverse=True)
        width = shapes.values.shape[1]
        deltas = np.zeros((len(used), stop - start, width))
        deltas[place, shapes.vertices[rows] - start] = shapes.values[rows]
        made.append(Block(start, stop, used, deltas.reshape(len(used), (stop - start) * width)))
    return made


def compose(neutral: np.ndarray, parts: list[Block], weights: np.ndarray) -> np.ndarray:
    """Add the weighted shape differences of some frames to the neutral.

    Parameters
    ----------
    neutral : (V, D) float array [character's unit]
    parts : from `blocks`
    weights : (T, K) float array, `u_li` of each frame

    Returns
    -------
    (T, V, D) float array [character's unit]

    Raises
    ------
    ValueError
        if the blocks are of another number of vertices or shapes
    """
    needed = max((int(part.shapes[-1]) + 1 for part in parts if len(part.shapes)), default=0)
    if parts[-1].stop != len(neutral) or weights.shape[1] < needed:
        raise ValueError(
            f"neutral {neutral.shape} and weights {weights.shape} do not fit blocks of"
            f" {parts[-1].stop} vertices and {needed} shapes"
        )
    moved = np.repeat(neutral[None], len(weights), axis=0)
    for start, stop, shapes, deltas in parts:
        added = weights[:, shapes] @ deltas
        moved[:, start:stop] += added.reshape(len(weights), *moved[0, start:stop].shape)
    return moved
