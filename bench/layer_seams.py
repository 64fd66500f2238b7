"""Where the lips of the example's characters meet: pairs of vertices, from their generators."""

from typing import NamedTuple

import numpy as np

from bench import layer_bodies
from data_example.generator import (
    cassette,
    cassette_parts,
    clay,
    globe,
    globe_features,
    tortoise,
)

# of the rings that are swept about a mouth, the one at the edge of the lips
GLOBE_ROW, CASSETTE_ROW = 2, 3


class Seam(NamedTuple):
    """Hold the vertices (n,) of a lower lip and those (n,) of the upper that they meet."""

    lower: np.ndarray
    upper: np.ndarray


def of(name: str) -> dict[str, Seam]:
    """Return the seam of every mouth of a character."""
    if name == "globe":
        slices = globe.Globe().parts.slices
        return {mouth: _in_piece(slices[mouth], 4, GLOBE_ROW) for mouth in globe_features.MOUTHS}
    if name == "cassette":
        piece = cassette.Cassette().parts.slices["mouth"]
        rows = (piece.stop - piece.start) // cassette_parts.RING
        return {"mouth": _in_piece(piece, rows, CASSETTE_ROW)}
    if name == "tortoise":
        return {"beak": _ring(tortoise.EDGE * tortoise.COLUMNS, tortoise.COLUMNS)}
    return {"mouth": _ring(clay.INNER * clay.RINGS, clay.RINGS)}


def _in_piece(piece: slice, rows: int, row: int) -> Seam:
    """Return the seam in one of the rings of a piece."""
    count = (piece.stop - piece.start) // rows
    return _ring(piece.start + row * count, count)


def _ring(first: int, count: int) -> Seam:
    """Return the seam of a ring that runs along the lower lip and back along the upper one."""
    inside = np.arange(1, count // 2)
    return Seam(first + inside, first + count - inside)


def gaps(body: layer_bodies.Body, u: np.ndarray) -> dict[str, np.ndarray]:
    """Return how far the lips of each mouth stand apart (T, n) along the seam [1, of the height].

    Parameters
    ----------
    body : the character
    u : (T, R, K) float array of displacements, or (T, C) of the character's columns
    """
    found = {}
    for mouth, seam in of(body.name).items():
        sides = [body.neutral[side] + layer_bodies.displaced(body, u, side) for side in seam]
        found[mouth] = np.linalg.norm(sides[0] - sides[1], axis=2) / body.height
    return found


def middle(gap: np.ndarray) -> np.ndarray:
    """Return the gap (T,) in the middle of a mouth."""
    return gap[:, gap.shape[1] // 2]
