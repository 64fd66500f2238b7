"""Tracked contours drawn over a picture of the film."""

from collections.abc import Sequence

import cv2
import numpy as np

SUBPIXEL_BITS = 4
DIM = np.array([128.0, 128.0, 128.0])
PALETTE = ((255, 138, 101), (100, 221, 160), (120, 190, 255), (255, 214, 102), (214, 158, 255))
SURE = 0.5


def draw_contour(
    picture: np.ndarray,
    points: np.ndarray,
    confidence: np.ndarray,
    colour: Sequence[int],
    closed: bool,
) -> None:
    """Draw a contour into a picture; parts of low confidence are thin and grey.

    Parameters
    ----------
    picture : (H, W, 3) uint8 array, drawn into
    points : (P, 2) float array [px], the centre of the first pixel at (0.5, 0.5)
    confidence : (P,) float array in 0..1
    colour : red, green, blue
    closed : whether the last point is joined to the first

    Notes
    -----
    Points that are NaN are left out, with the lines to them.
    """
    seen = np.isfinite(points).all(axis=1)
    places = np.round((np.where(seen[:, None], points, 0.0) - 0.5) * 2**SUBPIXEL_BITS).astype(int)
    if len(points) == 1 and seen[0]:
        shade, width = _stroke(colour, confidence[0])
        cv2.circle(picture, places[0], 4 << SUBPIXEL_BITS, shade, width, cv2.LINE_AA, SUBPIXEL_BITS)
        return
    for start in range(len(points) if closed else len(points) - 1):
        end = (start + 1) % len(points)
        if seen[start] and seen[end]:
            shade, width = _stroke(colour, min(confidence[start], confidence[end]))
            cv2.line(picture, places[start], places[end], shade, width, cv2.LINE_AA, SUBPIXEL_BITS)


def _stroke(colour: Sequence[int], confidence: float) -> tuple[list[int], int]:
    """Return the colour and width of a line, greyer where confidence is low."""
    share = float(np.clip(confidence, 0.0, 1.0)) if np.isfinite(confidence) else 0.0
    mixed = share * np.asarray(colour, float) + (1 - share) * DIM
    return [int(value) for value in mixed], 2 if share >= SURE else 1
