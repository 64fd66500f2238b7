"""Shapes as differences from a neutral, of which only the vertices that move are held.

A rig of hundreds of shapes is mostly zeros: a blink moves a lid and nothing else.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np


class LocalShapes(NamedTuple):
    """Hold K shapes of V vertices; shape k has the rows ``first[k]:first[k + 1]``.

    Attributes
    ----------
    first : (K + 1,) int64 array
    vertices : (N,) int32 array, ascending within a shape
    values : (N, D) float64 array, difference from the neutral [character's unit]
    count : V
    """

    first: np.ndarray
    vertices: np.ndarray
    values: np.ndarray
    count: int


def gather(deltas: Iterable[np.ndarray]) -> LocalShapes:
    """Keep the rows that are not zero of differences (V, D), which may be made one by one.

    Raises
    ------
    ValueError
        if there is no shape, or two differ in their form
    """
    vertices, values, forms = [], [], []
    for delta in deltas:
        moved = np.flatnonzero(np.asarray(delta).any(axis=1))
        vertices.append(moved.astype(np.int32))
        values.append(np.asarray(delta, float)[moved])
        forms.append(np.shape(delta))
    if not forms or len(set(forms)) > 1:
        raise ValueError(f"expected shapes (V, D) of one form, got {sorted(set(forms))}")
    first = np.cumsum([0, *map(len, vertices)])
    return LocalShapes(first, np.concatenate(vertices), np.concatenate(values), forms[0][0])


def select(shapes: LocalShapes, rows: np.ndarray, gains: np.ndarray) -> LocalShapes:
    """Return some of the shapes (M,), each multiplied by a gain (M,)."""
    parts = [slice(shapes.first[row], shapes.first[row + 1]) for row in rows]
    first = np.cumsum([0, *(part.stop - part.start for part in parts)]).astype(np.int64)
    vertices = [shapes.vertices[:0], *(shapes.vertices[part] for part in parts)]
    values = [shapes.values[:0]]
    values += [gain * shapes.values[part] for gain, part in zip(gains, parts, strict=True)]
    return LocalShapes(first, np.concatenate(vertices), np.concatenate(values), shapes.count)


def masked(shapes: LocalShapes, masks: np.ndarray, mask_index: np.ndarray) -> LocalShapes:
    """Multiply every shape by its mask: ``M_l (B_i - N)``.

    Parameters
    ----------
    shapes : K shapes of V vertices
    masks : (R, V) float array, one at every vertex in sum
    mask_index : (K,) int array, the mask of each shape

    Raises
    ------
    ValueError
        if the forms do not fit together
    """
    count = len(shapes.first) - 1
    if masks.shape[1:] != (shapes.count,) or np.shape(mask_index) != (count,):
        raise ValueError(
            f"masks {masks.shape} and mask_index {np.shape(mask_index)} do not fit"
            f" {count} shapes of {shapes.count} vertices"
        )
    owner = np.repeat(np.arange(count), np.diff(shapes.first))
    values = shapes.values * masks[np.asarray(mask_index)[owner], shapes.vertices][:, None]
    kept = values.any(axis=1)
    first = np.concatenate([[0], np.cumsum(np.bincount(owner[kept], minlength=count))])
    return LocalShapes(first, shapes.vertices[kept], values[kept], shapes.count)


def touched(shapes: LocalShapes) -> np.ndarray:
    """Return which shapes (K,) move anything."""
    return np.diff(shapes.first) > 0


def at(shapes: LocalShapes, vertices: np.ndarray) -> np.ndarray:
    """Return the differences of all shapes at some vertices (n,), dense: (K, n, D)."""
    count = len(shapes.first) - 1
    place = np.full(shapes.count, -1)
    unique, where = np.unique(vertices, return_inverse=True)
    place[unique] = np.arange(len(unique))
    found = np.zeros((count, len(unique), shapes.values.shape[1]))
    column = place[shapes.vertices]
    owner = np.repeat(np.arange(count), np.diff(shapes.first))
    found[owner[column >= 0], column[column >= 0]] = shapes.values[column >= 0]
    return found[:, where]


def dense(shapes: LocalShapes) -> np.ndarray:
    """Return the differences of all shapes at all vertices, (K, V, D)."""
    return at(shapes, np.arange(shapes.count))
