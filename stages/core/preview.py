"""Pictures of a preview: the film with its contours, the character beside it, a caption below."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import cv2
import numpy as np

from stages.core import overlay

HEIGHT = 480
STRIP_HEIGHT = 32
STRIP = (24, 25, 28)
TEXT = (222, 224, 228)
WARNING = (255, 176, 77)
FONT = cv2.FONT_HERSHEY_SIMPLEX
FONT_SIZE = 0.5
MARGIN = 12
BASE = 21


class Moment(NamedTuple):
    """Hold what the performance looks like at one time.

    Attributes
    ----------
    frame : its number
    time_s : its time [s]
    picture : (HEIGHT, W, 3) uint8 array
    confidence : 0..1
    """

    frame: int
    time_s: float
    picture: np.ndarray
    confidence: float


# rows of the contour's points, whether it is closed, number of its region (-1: none)
Outline = tuple[np.ndarray, bool, int]


def film_width(width: int, height: int) -> int:
    """Return the even width of the film's half when it is scaled to the preview's height."""
    return max(2, 2 * round(width * HEIGHT / height / 2))


def size(width: int) -> tuple[int, int]:
    """Return the width and height of a preview whose left side has some width [px]."""
    return width + HEIGHT, HEIGHT + STRIP_HEIGHT


def film_half(
    picture: np.ndarray, outlines: Sequence[Outline], points: np.ndarray, confidence: np.ndarray
) -> np.ndarray:
    """Scale a picture of the film to the preview's height and draw what was tracked in it.

    Parameters
    ----------
    picture : (H, W, 3) uint8 array
    outlines : the contours
    points : (P, 2) float array [px of the film]
    confidence : (P,) float array in 0..1

    Returns
    -------
    (HEIGHT, film_width, 3) uint8 array
    """
    height, width = picture.shape[:2]
    shown = film_width(width, height), HEIGHT
    shrinks = height > HEIGHT
    half = cv2.resize(picture, shown, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_LINEAR)
    scaled = points * [shown[0] / width, shown[1] / height]
    for rows, closed, region in outlines:
        colour = overlay.PALETTE[region % len(overlay.PALETTE)] if region >= 0 else overlay.DIM
        overlay.draw_contour(half, scaled[rows], confidence[rows], colour, closed)
    return half


def caption(width: int, left: str, right: str, warning: bool) -> np.ndarray:
    """Return a strip with one text at its left end and one, which may warn, at its right end.

    Returns
    -------
    (STRIP_HEIGHT, width, 3) uint8 array
    """
    strip = np.empty((STRIP_HEIGHT, width, 3), np.uint8)
    strip[:] = STRIP
    cv2.putText(strip, left, (MARGIN, BASE), FONT, FONT_SIZE, TEXT, 1, cv2.LINE_AA)
    length = cv2.getTextSize(right, FONT, FONT_SIZE, 1)[0][0]
    shade = WARNING if warning else TEXT
    place = (width - MARGIN - length, BASE)
    cv2.putText(strip, right, place, FONT, FONT_SIZE, shade, 1, cv2.LINE_AA)
    return strip


def frames(
    moments: Iterable[Moment], title: str, character: Callable[[float], np.ndarray]
) -> Iterator[tuple[float, np.ndarray]]:
    """Put a preview's pictures together.

    Parameters
    ----------
    moments : what the performance looks like, in order
    title : first words of the caption
    character : gives the (HEIGHT, HEIGHT, 3) uint8 picture of the character at a time [s]

    Yields
    ------
    time from the first picture [s], and (H, W, 3) uint8 picture
    """
    start_s = None
    for frame, time_s, picture, confidence in moments:
        start_s = time_s if start_s is None else start_s
        top = np.concatenate([picture, character(time_s)], axis=1)
        sure = float(np.nan_to_num(confidence))
        words = f"confidence {sure:.2f}" if sure > 0 else "not tracked"
        place = f"{title}   frame {frame}   {time_s:.2f} s"
        strip = caption(top.shape[1], place, words, sure < overlay.SURE)
        yield time_s - start_s, np.concatenate([top, strip])
