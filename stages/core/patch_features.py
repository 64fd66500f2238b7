"""Descriptors of small patches round points: oriented gradients of light and of colour.

Each gradient is divided by the mean gradient round it, so that light and exposure drop out, and
split by direction, so that a lip's upper and lower edge never cancel.
"""

import cv2
import numpy as np

LIGHT = np.array([0.299, 0.587, 0.114], np.float32)
RED_GREEN = np.array([1.5, -1.5, 0.0], np.float32)
DIRECTIONS = ((LIGHT, 6), (RED_GREEN, 4))
GRID = 5
SPACING_PX = 5.0
NEIGHBOURHOOD_PX = 25
NOISE_LEVEL = 2.0  # grey levels a pixel; flat skin must not be blown up


def gradients(image: np.ndarray) -> np.ndarray:
    """Return the normalised gradient, split by direction and softened.

    Parameters
    ----------
    image : (H, W, 3) uint8 array, RGB

    Returns
    -------
    (H, W, 10) float32 array, none negative
    """
    softened = cv2.GaussianBlur(image.astype(np.float32), (5, 5), 0.7)
    channels = []
    for mixture, count in DIRECTIONS:
        plane = cv2.transform(softened, mixture[None])
        x = cv2.Sobel(plane, cv2.CV_32F, 1, 0, scale=0.125)
        y = cv2.Sobel(plane, cv2.CV_32F, 0, 1, scale=0.125)
        # cv2.magnitude rounds by the alignment of its memory: other bytes from run to run
        size = np.sqrt(x * x + y * y)
        level = cv2.blur(size, (NEIGHBOURHOOD_PX, NEIGHBOURHOOD_PX)) + NOISE_LEVEL
        x, y = x / level, y / level
        for angle in 2 * np.pi * np.arange(count) / count:
            along = np.float32(np.cos(angle)) * x + np.float32(np.sin(angle)) * y
            channels.append(cv2.GaussianBlur(np.maximum(along, 0), (7, 7), 1.2))
    return cv2.merge(channels)


def describe(channels: np.ndarray, points: np.ndarray, spread: float) -> np.ndarray:
    """Sample the channels on a small grid round every point.

    Parameters
    ----------
    channels : (H, W, C) float32 array
    points : (P, 2) float array [px]
    spread : the grid's spacing, in units of its usual one

    Returns
    -------
    (P, 25 C) float32 array
    """
    ticks = (np.arange(GRID) - (GRID - 1) / 2) * SPACING_PX * spread
    offsets = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
    places = (points[:, None] + offsets - 0.5).astype(np.float32)
    found = cv2.remap(channels, places, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return found.reshape(len(points), -1)
