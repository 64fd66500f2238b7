"""A moving face laid on another rig of the same vertices, frame by frame (K11 section 5).

With the face's masked shapes ``a_k`` and weights ``u_k``, and the other rig's shapes ``b_m``:

    v(t) = argmin |sum_m v_m b_m - sum_k u_k(t) a_k|^2  subject to  lower <= v <= upper

Everything happens on inner products of shapes, so its cost does not depend on the vertices.
"""

from typing import NamedTuple

import numpy as np

from stages.core import box_least_squares, compose, local_shapes


class Products(NamedTuple):
    """Hold the inner products of two rigs' shapes over all vertices.

    Attributes
    ----------
    other : (M, M) float array, ``b_m' b_n``
    cross : (M, K) float array, ``b_m' a_k``
    own : (K, K) float array, ``a_k' a_l``
    moved : number of vertices that a shape of either rig moves
    """

    other: np.ndarray
    cross: np.ndarray
    own: np.ndarray
    moved: int


def products(own: local_shapes.LocalShapes, other: local_shapes.LocalShapes) -> Products:
    """Multiply the shapes of two rigs of the same vertices, run of vertices by run.

    Parameters
    ----------
    own : K masked shapes of the face that moves
    other : M masked shapes of the rig that it is laid on

    Raises
    ------
    ValueError
        if the numbers of vertices differ
    """
    if own.count != other.count:
        raise ValueError(f"shapes of {own.count} and of {other.count} vertices do not fit")
    count = len(own.first) - 1
    total = np.zeros((count + len(other.first) - 1,) * 2)
    for one, two in zip(compose.blocks(own), compose.blocks(other), strict=True):
        shapes = np.concatenate([one.shapes, count + two.shapes])
        deltas = np.concatenate([one.deltas, two.deltas])
        total[np.ix_(shapes, shapes)] += deltas @ deltas.T
    moved = len(np.union1d(own.vertices, other.vertices))
    return Products(total[count:, count:], total[count:, :count], total[:count, :count], moved)


def project(
    given: Products, weights: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Find the weights of the other rig that come nearest to the face, and how near.

    Parameters
    ----------
    given : from `products`
    weights : (T, K) float array of the face
    lower, upper : (M,) float array, limits of the other rig's weights

    Returns
    -------
    found : (T, M) float array
    residual : (T,) float array, root mean square distance of the vertices that either rig moves
        [character's unit]
    """
    linear = weights @ given.cross.T
    found = box_least_squares.solve_gram_frames(given.other, linear, lower, upper)
    squares = np.sum(found * (found @ given.other - 2.0 * linear), axis=1)
    squares += np.sum(weights * (weights @ given.own), axis=1)
    return found, np.sqrt(np.maximum(squares, 0.0) / max(given.moved, 1))
