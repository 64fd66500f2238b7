"""Where a vertex of a frame stands in a texture, and how its deviation becomes a pixel.

The deviation of a vertex from the neutral is `offset + gain * pixel`, with pixels within -1 and 1.
"""

from typing import NamedTuple

import numpy as np

# largest rounding error of a number within -1 and 1
ROUNDING = {"half": 2.0**-12, "float": 2.0**-25}
SIDES = tuple(2**power for power in range(6, 14))


class Scaling(NamedTuple):
    """Hold what brings deviations into pixels.

    Attributes
    ----------
    offset, gain : (3,) float array [unit]
    """

    offset: np.ndarray
    gain: np.ndarray


def per_axis(low: np.ndarray, high: np.ndarray) -> Scaling:
    """Scale each axis from its least and greatest deviation (3,) to 0 and 1."""
    return Scaling(low, np.where(high > low, high - low, 1.0))


def max_deviation(low: np.ndarray, high: np.ndarray) -> Scaling:
    """Divide all axes by the greatest deviation of any: a vertex at rest is exactly 0."""
    greatest = max(float(np.abs(low).max()), float(np.abs(high).max()))
    return Scaling(np.zeros(3), np.full(3, greatest or 1.0))


SCALINGS = {"per_axis": per_axis, "max_deviation": max_deviation}


def encode(deviations: np.ndarray, scaling: Scaling) -> np.ndarray:
    """Return the pixels of deviations (..., 3)."""
    return (deviations - scaling.offset) / scaling.gain


def plain_rows(frame: np.ndarray, block: np.ndarray, blocks: int) -> np.ndarray:
    """Return the rows of frames and blocks of vertices: all blocks of a frame stand together."""
    return frame * blocks + block


def openvat_rows(frame: np.ndarray, block: np.ndarray, frames: int) -> np.ndarray:
    """Return the rows of frames and blocks of vertices: all frames of a block stand together."""
    return block * frames + frame


def openvat_size(vertices: int, frames: int) -> tuple[int, int]:
    """Return width and height: powers of two from 64 on, one at most twice the other.

    The smallest area, and of those the narrowest, as OpenVAT chooses.

    Raises
    ------
    ValueError
        if even the largest texture is too small
    """
    fitting = []
    for width in SIDES:
        rows = frames * -(-vertices // width)
        height = max(1 << (rows - 1).bit_length(), width // 2, SIDES[0])
        if height <= min(2 * width, SIDES[-1]):
            fitting.append((width * height, width, height))
    if not fitting:
        largest = f"{SIDES[-1]} x {SIDES[-1]}"
        raise ValueError(f"{frames} frames of {vertices} vertices do not fit {largest} pixels")
    return min(fitting)[1:]


def lookup(vertices: int, width: int, height: int, first_rows: np.ndarray) -> np.ndarray:
    """Return the texture coordinates (V, 2) of the vertices' pixels in the first frame.

    The origin is the lower left corner; the centres of pixels are meant.

    Parameters
    ----------
    vertices, width, height : counts
    first_rows : (blocks,) int array, row of each block in the first frame, from the top
    """
    block, column = np.divmod(np.arange(vertices), width)
    return np.stack([(column + 0.5) / width, 1 - (first_rows[block] + 0.5) / height], axis=1)
