"""Characters as displacements of their columns, for trials of layers."""

from typing import NamedTuple

import numpy as np

from bench import layer_vignette
from stages.core import local_shapes
from stages.files import rig

MOVES_MM = 0.1


class Body(NamedTuple):
    """Hold a character as displacements of its columns.

    Attributes
    ----------
    name : of the character
    names : of its columns
    columns : mask and extreme of each column, (C, 2) int array
    moves : (C, V, 3) float array [mm], displacements under their masks
    neutral : (V, 3) float array [mm]
    masks : (R, V) float array
    moving : (V,) bool array, vertices that any column moves
    height : of the character, along y [mm]
    """

    name: str
    names: list[str]
    columns: np.ndarray
    moves: np.ndarray
    neutral: np.ndarray
    masks: np.ndarray
    moving: np.ndarray
    height: float


def body(take: layer_vignette.Take, name: str) -> Body:
    """Read a character."""
    made = rig.read_any(take.show / "results/cast" / layer_vignette.ACTOR / name / "rig.npz")
    place = {"_".join(extreme): k for k, extreme in enumerate(take.made.extremes)}
    columns = [
        (take.made.masks.index(mask), place[extreme])
        for mask, _, extreme in (column.partition(".") for column in made.names)
    ]
    unit = 1000 * rig.METRES[made.unit]
    moves = local_shapes.dense(local_shapes.masked(made.deltas, made.masks, made.mask_index)) * unit
    return Body(
        name,
        made.names,
        np.array(columns),
        moves,
        made.neutral * unit,
        made.masks[[made.mask_names.index(mask) for mask in take.made.masks]],
        np.linalg.norm(moves, axis=2).max(axis=0) > MOVES_MM,
        float(np.ptp(made.neutral[:, 1]) * unit),
    )


def weights_of(character: Body, u: np.ndarray) -> np.ndarray:
    """Return the weights (T, C) of a character's columns, given u (T, R, K) or those weights."""
    return u if u.ndim == 2 else u[:, character.columns[:, 0], character.columns[:, 1]]


def displaced(character: Body, u: np.ndarray, vertices=slice(None)) -> np.ndarray:
    """Return displacements (T, V, 3) [mm] of what layers make of a character."""
    moves = character.moves[:, vertices]
    flat = weights_of(character, u) @ moves.reshape(len(moves), -1)
    return flat.reshape(len(u), -1, 3)


def distance(character: Body, moved: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return the mean distance (T, 1 + R) [mm] over moving vertices, of all and of each mask."""
    apart = np.linalg.norm(moved - true, axis=2)
    chosen = [character.moving, *(character.moving & (mask > 0.5) for mask in character.masks)]
    return np.stack([apart[:, own].mean(axis=1) for own in chosen], axis=1)
