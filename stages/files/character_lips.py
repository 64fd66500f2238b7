"""The vertices about a character's lips, in each of its poses."""

import numpy as np

from stages.core import local_shapes
from stages.files import rig

HALF = 0.5  # of a vertex that a mask must hold


def read(found: rig.Rig, lip_mask: str, extremes: list[tuple[str, str]]) -> np.ndarray | None:
    """Return the lips' vertices in each extreme (K, N, 3) [face units]; None without a mesh.

    Parameters
    ----------
    found : the character's rig
    lip_mask : name of the mask; vertices that are mostly its own, as it moves them
    extremes : layer and name of each; those that the rig lacks are the neutral
    """
    if found.controls:
        return None
    mask = found.masks[found.mask_names.index(lip_mask)]
    own = np.flatnonzero(mask > HALF)
    names = [f"{lip_mask}.{layer}_{name}" for layer, name in extremes]
    held = [name for name in names if name in found.names]
    rows = np.array([found.names.index(name) for name in held], np.int64)
    shapes = np.repeat(found.neutral[own][None], len(names), axis=0)
    moved = local_shapes.at(local_shapes.select(found.deltas, rows, np.ones(len(rows))), own)
    shapes[[names.index(name) for name in held]] += moved * mask[own, None]
    return shapes / found.face_unit
