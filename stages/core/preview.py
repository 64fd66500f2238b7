"""Pictures of a preview: the film with its contours, the character beside it, a caption below."""

from collections.abc import Callable, Iterable, Iterator, Sequence

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

# rows of the contour's points, whether it is closed, number of its region (-1: none)
Outline = tuple[np.ndarray, bool, int]


def film_width(width: int, height: int) -> int:
    """Return the even width of the film's half when it is scaled to the preview's height."""
    return max(2, 2 * round(width * HEIGHT / height / 2))


def size(width: int, height: int) -> tuple[int, int]:
    """Return the width and height of the preview of a film of some size [px]."""
    return film_width(width, height) + HEIGHT, HEIGHT + STRIP_HEIGHT


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
    pictures: Iterable[tuple[int, np.ndarray]],
    tracked: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    outlines: Sequence[Outline],
    title: str,
    character: Callable[[float], np.ndarray],
) -> Iterator[tuple[float, np.ndarray]]:
    """Put a preview's pictures together.

    Parameters
    ----------
    pictures : row among the T tracked frames, and the film's picture
    tracked : frame (T,), time_s (T,), points (T, P, 2), their confidence (T, P), confidence (T,)
    outlines : the contours
    title : first words of the caption
    character : gives the (HEIGHT, HEIGHT, 3) uint8 picture of the character at a time [s]

    Yields
    ------
    time from the first picture [s], and (H, W, 3) uint8 picture
    """
    frame, time_s, points, point_confidence, confidence = tracked
    for row, picture in pictures:
        left = film_half(picture, outlines, points[row], point_confidence[row])
        top = np.concatenate([left, character(time_s[row])], axis=1)
        sure = float(np.nan_to_num(confidence[row]))
        words = f"confidence {sure:.2f}" if sure > 0 else "not tracked"
        place = f"{title}   frame {frame[row]}   {time_s[row]:.2f} s"
        strip = caption(top.shape[1], place, words, sure < overlay.SURE)
        yield time_s[row] - time_s[0], np.concatenate([top, strip])
