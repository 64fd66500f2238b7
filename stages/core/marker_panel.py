"""Markers seen from before the face, from a camera that stands still."""

from collections.abc import Callable

import cv2
import numpy as np

from stages.core import overlay

WIDTH = 360
HEIGHT = 480
GROUND = (24, 25, 28)
MEASURED = (222, 224, 228)
REPAIRED = (255, 176, 77)
RADIUS = 3
SHOWN = 0.9  # of the panel, by the middle of the take's places
STRAY = 0.005


def painter(points: np.ndarray, repaired: np.ndarray) -> Callable[[int], np.ndarray]:
    """Return a function that draws the markers of a frame, repaired ones in orange.

    Parameters
    ----------
    points : (T, P, 3) float array [any unit], x to the subject's left, y up; NaN: not drawn
    repaired : (T, P) float array, 0 where a place is as measured

    Returns
    -------
    function of a row among the frames that gives a (HEIGHT, WIDTH, 3) uint8 picture
    """
    flat = points[:, :, :2].reshape(-1, 2)
    known = flat[np.isfinite(flat).all(axis=1)]
    low, high = np.quantile(known, [STRAY, 1 - STRAY], axis=0) if len(known) else np.eye(2)
    scale = SHOWN * (np.array([WIDTH, HEIGHT]) / np.maximum(high - low, 1e-9)).min()
    places = (points[:, :, :2] - (low + high) / 2) * [scale, -scale] + [WIDTH / 2, HEIGHT / 2]

    def paint(row: int) -> np.ndarray:
        panel = np.empty((HEIGHT, WIDTH, 3), np.uint8)
        panel[:] = GROUND
        one = 1 << overlay.SUBPIXEL_BITS
        for place, mended in zip(places[row], repaired[row], strict=True):
            if np.isfinite(place).all() and np.abs(place).max() < WIDTH + HEIGHT:
                centre = np.round((place - 0.5) * one).astype(int)
                colour = REPAIRED if mended > 0 else MEASURED
                cv2.circle(
                    panel, centre, RADIUS * one, colour, -1, cv2.LINE_AA, overlay.SUBPIXEL_BITS
                )
        return panel

    return paint
