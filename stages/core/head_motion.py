"""The motion of a head in space from its markers, by the method of one's choice.

`published_svd` is D06's; `rigidity` weighs markers by how rigid the clip shows them to be,
`graduated_non_convexity` leaves out frame by frame what does not fit.
"""

import numpy as np

from stages.core import graduated_non_convexity, quaternions, resample, rigid_motion, rigidity


def _published_svd(
    points: np.ndarray, neutral: np.ndarray, origin: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """Fit with all markers alike (D06 equations 1 and 2)."""
    return rigid_motion.fit(points, neutral, np.ones(len(neutral)), origin)


METHODS = {
    "published_svd": _published_svd,
    "rigidity": rigidity.fit,
    "graduated_non_convexity": graduated_non_convexity.fit,
}


def solve(
    points: np.ndarray, neutral: np.ndarray, method: str, origin: int | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Find rotation (T, 3, 3) and translation (T, 3) of every frame, NaN where it cannot be told.

    Parameters
    ----------
    points : (T, P, 3) float array [face units]; NaN where not observed or not to be trusted
    neutral : (P, 3) float array [face units]
    method : one of `METHODS`
    origin : row of the point that is moved to the origin; None takes the centroid of the fit

    Raises
    ------
    ValueError
        if the method is none of these, or no frame has enough points
    """
    if method not in METHODS:
        raise ValueError(f"head method '{method}' is none of {', '.join(METHODS)}")
    rotation, translation = METHODS[method](points, neutral, origin)
    if not np.isfinite(rotation).any():
        raise ValueError(f"none of {len(points)} frames has {rigid_motion.MIN_POINTS} good markers")
    return rotation, translation


def filled(rotation: np.ndarray, translation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the motion as quaternions (T, 4) of continuous sign and translation (T, 3).

    Frames whose motion is unknown lie on the great circle and the line between their neighbours;
    at the ends the nearest is held.
    """
    known = np.isfinite(rotation).all(axis=(1, 2))
    place = resample.neighbours(known)
    turns = resample.continuous(quaternions.from_matrices(rotation[known]))
    # the head is nearer to the neutral than to its back
    turns = turns if turns[0, 3] >= 0 else -turns
    return resample.slerp(turns, *place), resample.linear(translation[known], *place)
