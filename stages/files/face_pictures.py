"""Pictures of a face cut out of its film."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from stages.files import film, series

WIDTH = 300  # of small pictures [px]
HALF_SIDE = 0.85  # of the larger extent of the tracked points: the whole face


def cut_out(
    video: str | Path, tracked_path: str | Path, frames: Sequence[int]
) -> dict[int, np.ndarray]:
    """Return the square of the picture round the face at frames of the constant clock.

    Parameters
    ----------
    video : the film
    tracked_path : its tracked points, at the film's own times
    frames : frames counted at the film's nominal rate

    Returns
    -------
    frame -> (H, W, 3) uint8 RGB array

    Raises
    ------
    errors.InputError
        if the film or the points cannot be read
    """
    tracked = series.read(tracked_path, "tracked")
    points = series.stack(tracked, tracked_path, series.point_names(tracked))
    times = [float(frame / tracked.rate) for frame in frames]
    rows = [int(np.abs(tracked.time_s - time).argmin()) for time in times]
    images = film.frames_at(video, [int(tracked.frame[row]) for row in rows], tracked_path)
    return {
        frame: _square(images[int(tracked.frame[row])], points[row])
        for frame, row in zip(frames, rows, strict=True)
    }


def at_times(video: str | Path, times_s: Sequence[float]) -> list[np.ndarray]:
    """Return the whole pictures of a film that are nearest to some times, small.

    Parameters
    ----------
    video : the film
    times_s : times from the first picture [s]

    Returns
    -------
    a (H, W, 3) uint8 RGB array for each time

    Raises
    ------
    errors.InputError
        if the film cannot be read
    """
    shown_s = film.picture_times(video)
    wanted = [int(np.abs(shown_s - time_s).argmin()) for time_s in times_s]
    kept = {}
    for number, (_, picture) in enumerate(film.read_frames(video)):
        if number in wanted:
            kept[number] = _small(picture)
    return [kept[number] for number in wanted]


def _small(image: np.ndarray) -> np.ndarray:
    """Shrink a picture to a width that a page needs."""
    height, width = image.shape[:2]
    if width <= WIDTH:
        return image
    size = WIDTH, round(height * WIDTH / width)
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA)


def _square(image: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the square of a picture round (P, 2) points; all of it where none is known."""
    known = points[np.isfinite(points).all(axis=1)]
    if len(known) == 0:
        return image
    low, high = known.min(axis=0), known.max(axis=0)
    half, centre = HALF_SIDE * (high - low).max(), (low + high) / 2
    x0, y0 = np.maximum(np.round(centre - half), 0).astype(int)
    x1, y1 = np.round(centre + half).astype(int)
    return image[y0:y1, x0:x1]
