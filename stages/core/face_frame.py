"""The frame in which faces are compared: upright, of one size, the mean shape in the middle."""

import dataclasses

import numpy as np

from stages.core import similarity


@dataclasses.dataclass(frozen=True)
class FaceFrame:
    """A small picture frame round the mean shape.

    Attributes
    ----------
    points : (P, 2) float array [px of the frame], the mean shape
    size : width and height [px]
    """

    points: np.ndarray
    size: tuple[int, int]

    def pose(self, points: np.ndarray) -> np.ndarray:
        """Return the similarity (2, 3) from the frame to where a shape (P, 2) lies."""
        return similarity.fit_similarity(self.points, points)


def around(mean: np.ndarray, margin: float) -> FaceFrame:
    """Lay a frame round a mean shape.

    Parameters
    ----------
    mean : (P, 2) float array [px]
    margin : room on every side [px]
    """
    low = mean.min(axis=0) - margin
    size = np.ceil(mean.max(axis=0) + margin - low).astype(int)
    return FaceFrame(mean - low, (int(size[0]), int(size[1])))


def widened(frame: FaceFrame, margin: int) -> FaceFrame:
    """Return a frame with more room on every side [px]."""
    width, height = frame.size
    return FaceFrame(frame.points + margin, (width + 2 * margin, height + 2 * margin))
