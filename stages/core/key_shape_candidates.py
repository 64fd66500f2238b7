"""What every selector of key shapes is given, and what it gives back."""

from typing import NamedTuple

import numpy as np

from stages.core import pca


class Candidates(NamedTuple):
    """Hold the frames of one region that key shapes are chosen from.

    Attributes
    ----------
    frames : (T, D) float array [feature unit]
    neutral : (D,) float array [feature unit]
    model : pca.Pca
        Axes of these frames.
    eligible : (T,) bool array
        False for frames of low confidence and banned ones.
    locked : tuple of int
        Frames that the artist has settled; taken first, whatever `eligible` says.
    seed : int
        Of the clustering.
    sigma : float
        Error expected of a sculpt as a share of its distance from the neutral.
    """

    frames: np.ndarray
    neutral: np.ndarray
    model: pca.Pca
    eligible: np.ndarray
    locked: tuple[int, ...] = ()
    seed: int = 0
    sigma: float = 0.1


class Choice(NamedTuple):
    """Name a chosen frame and say in plain words why."""

    frame: int
    reason: str


LOCKED = "locked by the artist"


def locked_choices(candidates):
    """Return the choices that are settled before a selector starts."""
    return [Choice(frame, LOCKED) for frame in candidates.locked]


def free(candidates, chosen):
    """Return which frames (T,) may still be chosen besides those in `chosen`."""
    mask = candidates.eligible.copy()
    mask[[choice.frame for choice in chosen]] = False
    return mask


def check(candidates, count):
    """Refuse a count that the frames cannot fill.

    Raises
    ------
    ValueError
        When the count is below one, below the number of locked frames, or above the number
        of eligible frames.
    """
    locked = len(candidates.locked)
    available = locked + np.count_nonzero(free(candidates, locked_choices(candidates)))
    if not max(1, locked) <= count <= available:
        raise ValueError(
            f"{count} key shapes cannot be chosen: {locked} frames are locked "
            f"and {available} of {len(candidates.frames)} can be used; "
            "change the count, or unlock or unban frames"
        )
