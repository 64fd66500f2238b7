"""The gap of an actor's lips in the shots from which the extremes were picked."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import lip_estimate
from stages.files import errors, expressions, extremes, layer_points, lip_gap, picked_frames


def read(
    paths: Sequence[str | Path],
    shots: Sequence[str],
    pair: str,
    actor: picked_frames.PickedFrames,
) -> dict[str, np.ndarray]:
    """Return the distance (T,) [face units] of a pair of points in every shot that was picked from.

    Parameters
    ----------
    paths : an expression for each shot
    shots : their names
    pair : `upper,lower`, names of the two points
    actor : the points of those shots
    """
    path_of = dict(zip(shots, paths, strict=True))
    return {
        shot: lip_gap.read(path_of[shot], pair, np.array(list(frames)))
        for shot, frames in actor.frames.items()
    }


def at(
    gaps: dict[str, np.ndarray],
    actor: picked_frames.PickedFrames,
    picked: Sequence[expressions.Picked],
) -> np.ndarray:
    """Return the distance on the frame of each extreme (K,), NaN where not observed."""
    return np.array([gaps[row.shot][actor.frames[row.shot][row.frame]] for row in picked])


def closed_row(
    table: str | Path, actor: str, picked: Sequence[expressions.Picked], cure: str
) -> expressions.Picked:
    """Return the row of the closed lips.

    Raises
    ------
    errors.InputError
        if there is none
    """
    for row in picked:
        if (row.layer, row.name) == extremes.CLOSED_LIPS:
            return row
    speech, name = extremes.CLOSED_LIPS
    message = f"{actor} has no row for {speech} {name}, the closed lips"
    raise errors.InputError(table, f"{message}: add it, or {cure}")


def told(
    gaps: dict[str, np.ndarray],
    actor: picked_frames.PickedFrames,
    layout: layer_points.Layout,
    scale: np.ndarray,
    chosen: np.ndarray,
    closed: np.ndarray,
) -> tuple[np.ndarray, float]:
    """Return weights (D,) and start of what tells the gap less that of closed lips.

    Parameters
    ----------
    gaps, actor : see above
    layout : the points that are used, of D coordinates
    scale : (D,) float array, by which coordinates are balanced
    chosen : (D,) bool array, coordinates that may tell
    closed : (D,) float array, offsets of the closed lips
    """
    kept = layer_points.coordinates_of(actor.layout, layout)
    offsets = np.concatenate([actor.offsets[shot][:, kept] for shot in gaps]) * scale
    found = lip_estimate.fit(offsets, np.concatenate(list(gaps.values())), chosen)
    if found is None:
        return np.zeros(len(scale)), 0.0
    return found.weights, -float(closed * scale @ found.weights)
