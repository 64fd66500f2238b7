"""The whole tracker, applied to one picture after another: follow, judge, lose, find again."""

import dataclasses

import numpy as np

from stages.core import confidence, descent, eigen_points, face_frame, face_search

LOST_BELOW = 0.5
CANDIDATES = 3


@dataclasses.dataclass(frozen=True)
class FaceTracker:
    """A trained tracker.

    Attributes
    ----------
    frame : the frame in which faces are compared
    groups : int arrays, the points that are refined and judged together
    eigen : the eigen-points
    cascade : the refinement; without stages for plain eigen-points
    judge : says how far to trust a point
    finder : finds the face in a whole picture
    """

    frame: face_frame.FaceFrame
    groups: tuple[np.ndarray, ...]
    eigen: eigen_points.EigenPoints
    cascade: descent.Descent
    judge: confidence.Judge
    finder: face_search.Finder


@dataclasses.dataclass(frozen=True)
class Sighting:
    """A face as found in a picture.

    Attributes
    ----------
    points : (P, 2) float array [px]
    confidence : (P,) float array, 0 to 1
    face_confidence : 0 to 1
    residual : root mean square of the pixels off the eigen-points' subspace
    """

    points: np.ndarray
    confidence: np.ndarray
    face_confidence: float
    residual: float


def sight(tracker: FaceTracker, picture: np.ndarray, points: np.ndarray) -> Sighting:
    """Find the face near where it was and judge what was found.

    Parameters
    ----------
    tracker : the tracker
    picture : (H, W, 3) uint8 array, RGB
    points : (P, 2) float array [px], where the face was
    """
    found, residual = eigen_points.project(tracker.eigen, tracker.frame, picture, points)
    found, look = descent.refine(tracker.cascade, tracker.frame, tracker.groups, picture, found)
    trust, face = confidence.judge(tracker.judge, descent.describe(look, found), tracker.groups)
    height, width = picture.shape[:2]
    outside = ((found < 0) | (found > [width, height])).any(axis=1)
    return Sighting(found, np.where(outside, 0.0, trust), face, residual)


def track(
    tracker: FaceTracker, picture: np.ndarray, previous: np.ndarray | None
) -> Sighting | None:
    """Follow the face into the next picture; search the picture where that fails.

    Parameters
    ----------
    tracker : the tracker
    picture : (H, W, 3) uint8 array, RGB
    previous : (P, 2) float array [px], where the face was; None if nobody knows

    Returns
    -------
    what was found; None where no face is to be trusted
    """
    if previous is not None:
        followed = sight(tracker, picture, previous)
        if followed.face_confidence >= LOST_BELOW:
            return followed
    best = None
    for start in face_search.search(tracker.finder, tracker.frame, picture, CANDIDATES):
        found = sight(tracker, picture, sight(tracker, picture, start).points)
        if best is None or found.face_confidence > best.face_confidence:
            best = found
    return best if best is not None and best.face_confidence >= LOST_BELOW else None
