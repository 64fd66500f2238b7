"""Repair a take of markers: undo exchanges, take out what is mistaken, fill what is missing."""

from typing import NamedTuple

import numpy as np

from stages.core import face_alignment, marker_faults, marker_gaps

MEASURED, FILLED, MISTAKEN = 0, 1, 2
FEWEST = 5


class Repaired(NamedTuple):
    """Hold a repaired take.

    Attributes
    ----------
    points : (T, P, 3) float array [mm], NaN where nothing is known
    repaired : (T, P) int8 array: 0 measured or unknown, 1 a gap filled, 2 mistaken, which is
        replaced or unknown
    faults : the mistakes that were found
    gaps : the gaps of the take as it came, markers that are never seen left out
    """

    points: np.ndarray
    repaired: np.ndarray
    faults: list[marker_faults.Stretch]
    gaps: list[marker_gaps.Gap]


def repair(points: np.ndarray, longest: int) -> Repaired:
    """Repair markers in a frame that moves with the head; what was measured stays as it is.

    Parameters
    ----------
    points : (T, P, 3) float array [mm], NaN where not observed
    longest : length of the longest stretch that is filled [frames]

    Returns
    -------
    Repaired
    """
    seen = np.isfinite(points[..., 0])
    gaps = [gap for gap in marker_gaps.gaps_of(points) if seen[:, gap.marker].any()]
    repaired = np.zeros(seen.shape, np.int8)
    if (seen.sum(axis=1) >= FEWEST).sum() < FEWEST:
        return Repaired(points, repaired, [], gaps)
    motion = face_alignment.align(points)
    face = face_alignment.to_face(points, motion)
    faults = marker_faults.find(face)
    made = points.copy()
    for stretch in faults:
        frames = slice(stretch.first, stretch.last + 1)
        repaired[frames, stretch.marker] = MISTAKEN
        source = points[frames, stretch.partner] if stretch.partner >= 0 else np.nan
        made[frames, stretch.marker] = source
    face = face_alignment.to_face(made, motion)
    filled = face_alignment.from_face(marker_gaps.fill(face, longest), motion)
    lost = np.isnan(made[..., 0]) & np.isfinite(filled[..., 0])
    made[lost] = filled[lost]
    repaired[lost & (repaired == MEASURED)] = FILLED
    return Repaired(made, repaired, faults, gaps)
