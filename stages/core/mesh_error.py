"""How far errors of weights move the vertices of a mesh."""

import numpy as np

from stages.core import compose

FRAMES = 256


def worst(parts: list[compose.Block], wrong: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest displacement of each frame (T,) [unit] and its vertex (T,).

    Parameters
    ----------
    parts : from `compose.blocks`, shapes under their masks
    wrong : (T, K) float array, differences of weights
    """
    largest = np.zeros(len(wrong))
    vertex = np.zeros(len(wrong), int)
    for first in range(0, len(wrong), FRAMES):
        rows = slice(first, first + FRAMES)
        for start, stop, shapes, deltas in parts:
            if not len(shapes):
                continue
            moved = wrong[rows][:, shapes] @ deltas
            moved = moved.reshape(len(moved), stop - start, -1)
            squares = np.einsum("tvd,tvd->tv", moved, moved)
            place = squares.argmax(axis=1)
            here = squares[np.arange(len(squares)), place]
            above = here > largest[rows]
            largest[rows][above] = here[above]
            vertex[rows][above] = start + place[above]
    return np.sqrt(largest), vertex
