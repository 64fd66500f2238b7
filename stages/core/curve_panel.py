"""Curves of named controls as a picture that a playhead runs over."""

from collections.abc import Sequence

import cv2
import numpy as np

BACKGROUND = (44, 45, 49)
LANE = (54, 56, 61)
CURVE = (120, 190, 255)
PLAYHEAD = (255, 176, 77)
TEXT = (222, 224, 228)
MAX_LANES = 24
MARGIN = 12
NAMES_WIDTH = 150
VALUES_WIDTH = 62
FONT = cv2.FONT_HERSHEY_SIMPLEX
FONT_SIZE = 0.42
SUBPIXEL = 16


def liveliest(values: np.ndarray) -> np.ndarray:
    """Return the curves to show, in their order: where there are too many, those that move most.

    Parameters
    ----------
    values : (T, V) float array

    Returns
    -------
    (at most MAX_LANES,) int array
    """
    moved = np.ptp(values, axis=0)
    return np.sort(np.argsort(-moved, kind="stable")[:MAX_LANES])


def draw_lanes(names: Sequence[str], values: np.ndarray, side: int) -> np.ndarray:
    """Draw every curve in a lane of its own, from its least to its greatest value.

    Parameters
    ----------
    names : of the curves
    values : (T, V) float array
    side : of the picture [px]

    Returns
    -------
    (side, side, 3) uint8 array
    """
    panel = np.empty((side, side, 3), np.uint8)
    panel[:] = BACKGROUND
    tops, height = _lanes(len(names), side)
    shares = _shares(values)
    across = np.linspace(NAMES_WIDTH, side - VALUES_WIDTH, len(values))
    for name, top, share in zip(names, tops, shares.T, strict=True):
        cv2.rectangle(panel, (NAMES_WIDTH, top), (side - VALUES_WIDTH, top + height), LANE, -1)
        place = (MARGIN, top + height // 2 + 5)
        cv2.putText(panel, name[:20], place, FONT, FONT_SIZE, TEXT, 1, cv2.LINE_AA)
        line = np.stack([across, top + 2 + (1 - share) * (height - 4)], axis=1)
        line = np.round(line * SUBPIXEL).astype(np.int32)
        cv2.polylines(panel, [line], isClosed=False, color=CURVE, lineType=cv2.LINE_AA, shift=4)
    return panel


def draw_playhead(lanes: np.ndarray, values: np.ndarray, row: int) -> np.ndarray:
    """Draw where the curves stand at one frame.

    Parameters
    ----------
    lanes : (side, side, 3) uint8 array from `draw_lanes`
    values : (T, V) float array, the same
    row : the frame

    Returns
    -------
    (side, side, 3) uint8 array
    """
    panel = lanes.copy()
    side = len(panel)
    tops, height = _lanes(values.shape[1], side)
    width = side - VALUES_WIDTH - NAMES_WIDTH
    x = round(NAMES_WIDTH + width * row / max(len(values) - 1, 1))
    cv2.line(panel, (x, tops[0]), (x, tops[-1] + height), PLAYHEAD, 1, cv2.LINE_AA)
    for top, share, value in zip(tops, _shares(values)[row], values[row], strict=True):
        y = round(top + 2 + (1 - share) * (height - 4))
        cv2.circle(panel, (x, y), 4, PLAYHEAD, -1, cv2.LINE_AA)
        place = (side - VALUES_WIDTH + 6, top + height // 2 + 5)
        cv2.putText(panel, f"{value:.3g}", place, FONT, FONT_SIZE, TEXT, 1, cv2.LINE_AA)
    return panel


def _lanes(count: int, side: int) -> tuple[list[int], int]:
    """Return the upper edges of the lanes and their height [px]."""
    step = min((side - 2 * MARGIN) / count, side / 6)
    return [round(MARGIN + index * step) for index in range(count)], max(round(step) - 4, 6)


def _shares(values: np.ndarray) -> np.ndarray:
    """Return values as shares of each curve's range; the middle where a curve stands still."""
    low, extent = values.min(axis=0), np.ptp(values, axis=0)
    return np.where(extent > 0, (values - low) / np.where(extent > 0, extent, 1.0), 0.5)
