"""Choose the capture frames that an animator tunes: phones, extremes, and what is left.

The paper's scheme (D06 section 4): for each viseme in each expression the middle frame of a phone,
and ten more frames with extreme poses for each expression. Among several phones of a viseme the one
whose middle looks most like the others is taken, since the paper leaves that to a person.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

EXTREMES = 10


class Reference(NamedTuple):
    """Hold a chosen frame.

    Attributes
    ----------
    row : index among the frames
    source : `viseme`, `extreme` or `coverage`
    viseme : its viseme, or an empty text
    """

    row: int
    source: str
    viseme: str


def typical(features: np.ndarray, rows: Sequence[int]) -> int:
    """Return the row whose features are nearest to the mean of some rows."""
    own = features[list(rows)]
    return int(rows[int(np.linalg.norm(own - own.mean(axis=0), axis=1).argmin())])


def viseme_frames(
    features: np.ndarray,
    middles: Sequence[tuple[int, str]],
    emotions: Sequence[str],
    eligible: np.ndarray,
) -> list[Reference]:
    """Choose a frame for each viseme in each emotion.

    Parameters
    ----------
    features : (T, C) float array, coordinates of the frames on principal axes
    middles : the row of each phone's middle frame, and its viseme
    emotions : (T,) the emotion that is played on each frame
    eligible : (T,) bool array, frames that may be chosen
    """
    groups: dict[tuple[str, str], list[int]] = {}
    for row, viseme in middles:
        if eligible[row]:
            groups.setdefault((emotions[row], viseme), []).append(row)
    return [
        Reference(typical(features, rows), "viseme", viseme)
        for (_, viseme), rows in sorted(groups.items())
    ]


def extreme_frames(
    features: np.ndarray,
    chosen: Sequence[int],
    emotions: Sequence[str],
    eligible: np.ndarray,
    count: int = EXTREMES,
) -> list[Reference]:
    """Choose frames of each emotion that lie farthest from the mean and from all chosen before.

    Greedy: each frame maximises ``min_j |x - x_j|`` over the mean and the frames chosen so far.

    Parameters
    ----------
    features : (T, C) float array
    chosen : rows that are chosen already
    emotions : (T,) the emotion that is played on each frame
    eligible : (T,) bool array
    count : frames for each emotion
    """
    mean = features[eligible].mean(axis=0)
    distance = np.linalg.norm(features - mean, axis=1)
    for row in chosen:
        distance = np.minimum(distance, np.linalg.norm(features - features[row], axis=1))
    names = np.asarray(emotions)
    found = []
    for emotion in sorted(set(names[eligible])):
        own = eligible & (names == emotion)
        for _ in range(min(count, np.count_nonzero(own))):
            row = int(np.where(own, distance, -1.0).argmax())
            if distance[row] <= 0:
                break
            found.append(Reference(row, "extreme", ""))
            distance = np.minimum(distance, np.linalg.norm(features - features[row], axis=1))
    return found
