"""How a character moves in a take, in its own axes and unit, and where that brings its vertices."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from stages.core import compose, head_transform, local_shapes

# frames that are composed at once
CHUNK = 32


class TakeMotion(NamedTuple):
    """Hold what moves a character.

    Attributes
    ----------
    weights : (T, K) float array, of its shapes
    rotation : (T, 4) float array, quaternions x, y, z, w of length one
    translation : (T, 3) float array [unit]
    scale : (T,) float array
    """

    weights: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    scale: np.ndarray


def in_axes(motion: TakeMotion, up_axis: str, face_unit: float) -> TakeMotion:
    """Turn head motion from the face's axes and face units into a character's axes and unit.

    Parameters
    ----------
    motion : in the face's axes, translation [face units], quaternions of any length
    up_axis : `y` or `z`
    face_unit : length of one face unit [unit]
    """
    axes = head_transform.face_axes(up_axis)
    return motion._replace(
        rotation=head_transform.turned_quaternions(motion.rotation, axes),
        translation=face_unit * motion.translation @ axes.T,
    )


def positions(
    neutral: np.ndarray,
    masked: local_shapes.LocalShapes,
    pivot: np.ndarray,
    motion: TakeMotion,
) -> Iterator[np.ndarray]:
    """Yield the (V, 3) float64 positions of every frame [unit].

    Parameters
    ----------
    neutral : (V, 3) float array [unit]
    masked : K shapes from `local_shapes.masked`
    pivot : (3,) float array, the point about which the head turns [unit]
    motion : in the character's axes
    """
    blocks = compose.blocks(masked)
    for frame in range(len(motion.weights)):
        if frame % CHUNK == 0:
            rows = motion.weights[frame : frame + CHUNK]
            shapes = compose.compose(neutral, blocks, rows)
        rotation = head_transform.rotation_matrix(motion.rotation[frame])
        yield head_transform.apply(
            shapes[frame % CHUNK], rotation, motion.translation[frame], motion.scale[frame], pivot
        )
