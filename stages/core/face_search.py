"""Finding the face in a whole picture: the mean face slid over it at several sizes and angles."""

import dataclasses

import cv2
import numpy as np

from stages.core import face_frame, similarity, warp

TEMPLATE_PX = 24
SIZE_RATIO = 1.15
SIZES_BEYOND = 2
ANGLES = (-0.3, 0.0, 0.3)
APART = 0.5


@dataclasses.dataclass(frozen=True)
class Finder:
    """The mean face, small, and the sizes at which to look for it.

    Attributes
    ----------
    template : (h, w) float32 array, light
    shrink : px of the face frame a px of the template
    scales : (S,) float array, px of the picture a px of the face frame
    """

    template: np.ndarray
    shrink: float
    scales: np.ndarray


def train(faces: np.ndarray, scales: np.ndarray, frame: face_frame.FaceFrame) -> Finder:
    """Average faces into a template.

    Parameters
    ----------
    faces : (N, H, W, 3) uint8 array in the face frame
    scales : (N,) float array, px of the picture a px of the face frame, of the labelled frames
    frame : the face frame
    """
    shrink = max(frame.size) / TEMPLATE_PX
    size = tuple(round(side / shrink) for side in frame.size)
    small = [
        cv2.resize(cv2.cvtColor(face, cv2.COLOR_RGB2GRAY), size, interpolation=cv2.INTER_AREA)
        for face in faces
    ]
    low = np.log(scales.min()) - SIZES_BEYOND * np.log(SIZE_RATIO)
    high = np.log(scales.max()) + SIZES_BEYOND * np.log(SIZE_RATIO)
    count = int(np.ceil((high - low) / np.log(SIZE_RATIO))) + 1
    return Finder(
        np.mean(small, axis=0).astype(np.float32), shrink, np.exp(np.linspace(low, high, count))
    )


def search(
    finder: Finder, frame: face_frame.FaceFrame, picture: np.ndarray, wanted: int
) -> list[np.ndarray]:
    """Return where the mean shape correlates best with the picture, best first.

    Parameters
    ----------
    finder : the mean face
    frame : the face frame
    picture : (H, W, 3) uint8 array
    wanted : greatest number of candidates

    Returns
    -------
    list of (P, 2) float arrays [px of the picture], no two at the same place
    """
    light = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    found = []
    for scale in finder.scales:
        pixel = scale * finder.shrink
        for angle in ANGLES:
            found += _at(finder, frame, light, pixel, angle, wanted)
    found.sort(key=lambda one: -one[0])
    kept: list[np.ndarray] = []
    for _, points in found:
        reach = APART * np.ptp(points, axis=0).min()
        middle = points.mean(axis=0)
        if all(np.linalg.norm(middle - other.mean(axis=0)) > reach for other in kept):
            kept.append(points)
        if len(kept) == wanted:
            break
    return kept


def _at(
    finder: Finder,
    frame: face_frame.FaceFrame,
    light: np.ndarray,
    pixel: float,
    angle: float,
    wanted: int,
) -> list[tuple[float, np.ndarray]]:
    """Return the best matches at one size and angle, with their correlations."""
    height, width = light.shape
    margin = TEMPLATE_PX // 3
    size = (round(width / pixel) + 2 * margin, round(height / pixel) + 2 * margin)
    middle, centre = np.array(size) / 2, np.array([width, height]) / 2
    to_picture = similarity.about(middle, angle, pixel, centre - middle)
    blurred = cv2.blur(light, (max(round(pixel), 1), max(round(pixel), 1)))
    small = warp.prewarp(blurred, to_picture, size).astype(np.float32)
    rows, columns = finder.template.shape
    if small.shape[0] < rows or small.shape[1] < columns:
        return []
    match = cv2.matchTemplate(small, finder.template, cv2.TM_CCOEFF_NORMED)
    found = []
    for _ in range(wanted):
        _, value, _, (x, y) = cv2.minMaxLoc(match)
        place = frame.points / finder.shrink + [x, y]
        found.append((value, similarity.apply(to_picture, place)))
        cv2.circle(match, (x, y), max(rows // 3, 1), -1.0, -1)
    return found
