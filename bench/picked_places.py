"""Places on the character that correspond to the actor's markers, as a person would pick them.

Both rigs name their shapes alike, so the middle of what a shape moves is one place on both faces.
The actor's markers are laid on the character by a scale per axis that brings these middles
together, are bent towards what is left of them, and fall on the nearest vertex.
"""

from typing import NamedTuple

import numpy as np

from bench import rig_take

# of those tried, kindest to the blendshape equation
REACH_MM, STIFFNESS = 60.0, 0.1


class Places(NamedTuple):
    """Hold places on the character at rest (P, 3) and what shapes do there (C, P, 3) [mm]."""

    neutral: np.ndarray
    deltas: np.ndarray


def pick(folder, names, bent=True):
    """Return the places of the actor's markers; by scale per axis alone if not `bent`."""
    actor, character = rig_take.actor(folder, names), rig_take.character(folder, names)
    ours, theirs = _middles(rig_take.whole_actor(folder, names)), _middles(character)
    both = np.isfinite(ours).all(axis=1) & np.isfinite(theirs).all(axis=1)
    ours, theirs = ours[both], theirs[both]
    centred = ours - ours.mean(axis=0)
    scale = np.sum(centred * theirs, axis=0) / np.sum(centred**2, axis=0)
    shift = theirs.mean(axis=0) - scale * ours.mean(axis=0)
    laid, middles = actor.neutral * scale + shift, ours * scale + shift
    if bent:
        near = _nearness(middles, middles) + STIFFNESS * np.eye(len(middles))
        laid += _nearness(laid, middles) @ np.linalg.solve(near, theirs - middles)
    apart = np.linalg.norm(laid[:, None] - character.neutral[None], axis=2)
    nearest = apart.argmin(axis=1)
    return Places(character.neutral[nearest], character.deltas[:, nearest])


def _middles(rig):
    """Return the middle (C, 3) of what every shape moves, NaN where it moves nothing."""
    moved = np.sum(rig.deltas**2, axis=2)
    total = moved.sum(axis=1, keepdims=True)
    return moved @ rig.neutral / np.where(total > 0, total, np.nan)


def _nearness(points, others):
    """Return how near points are to others, 1 at the same place."""
    apart = np.sum((points[:, None] - others[None]) ** 2, axis=2)
    return np.exp(-apart / (2 * REACH_MM**2))
