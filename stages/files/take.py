"""A take of a mesh: its character, its masked shapes, and what moves them."""

import dataclasses
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.core import local_shapes, take_motion
from stages.files import errors, rig, weights


@dataclasses.dataclass(frozen=True)
class Take:
    """A character and its motion.

    Attributes
    ----------
    character : the rig of a mesh
    masked : its K shapes under their masks
    motion : in the character's axes and unit
    frame : (T,) int array
    rate : frames per second
    time_s : (T,) float array [s]
    first_timecode : of the first frame, or an empty text
    """

    character: rig.Rig
    masked: local_shapes.LocalShapes
    motion: take_motion.TakeMotion
    frame: np.ndarray
    rate: Fraction
    time_s: np.ndarray
    first_timecode: str

    @property
    def start(self) -> dict[str, str]:
        """What files say of the first frame: its timecode, where it is known."""
        return {"start_timecode": self.first_timecode} if self.first_timecode else {}


def read(rig_path: str | Path, weights_path: str | Path) -> Take:
    """Read a take.

    Raises
    ------
    errors.InputError
        if a file is not what it should be, the weights are of another rig or have no frame
    """
    character = rig.read(rig_path, "mesh")
    played = weights.read(weights_path, character.names)
    if not len(played.frame):
        raise errors.InputError(weights_path, "has no frame: run smooth_weights again")
    if not (played.scale > 0).all():
        frame = played.frame[np.argmin(played.scale)]
        message = f"frame {frame}: the head's scale is not positive: see align_head's result"
        raise errors.InputError(weights_path, message)
    masked = local_shapes.masked(character.deltas, character.masks, character.mask_index)
    head = take_motion.TakeMotion(played.shapes, played.rotation, played.translation, played.scale)
    motion = take_motion.in_axes(head, character.up_axis, character.face_unit)
    return Take(
        character, masked, motion, played.frame, played.rate, played.time_s, played.first_timecode
    )


def positions(played: Take, weights_path: str | Path) -> Iterator[np.ndarray]:
    """Yield the (V, 3) float32 positions of every frame.

    Raises
    ------
    errors.InputError
        naming the weights if a position is not finite in float32
    """
    character = played.character
    for shape in take_motion.positions(
        character.neutral, played.masked, character.pivot, played.motion
    ):
        with np.errstate(over="ignore"):
            rounded = shape.astype(np.float32)
        if not np.isfinite(rounded).all():
            raise errors.InputError(weights_path, "moves vertices beyond float32")
        yield rounded
