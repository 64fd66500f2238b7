"""Landmarks of a film as another tracker's file holds them."""

import dataclasses
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import errors

# points of a face -> the tracker that counts them so; its map has this name
TRACKERS = {478: "mediapipe", 468: "mediapipe", 68: "ibug68"}
NORMALISED = 2.0  # coordinates of pictures as a whole are below it, pixels of a face above


@dataclasses.dataclass(frozen=True)
class LandmarkTake:
    """Landmarks as read: a row for each row of the file.

    Attributes
    ----------
    choices : tracker -> (T, P, 2) float array in the order of its indices, NaN where not found;
        the first that has a map is taken; named points stand under an empty name
    names : the P names of named points
    confidence : (T,) float array in 0..1
    frame : (T,) int array as the file numbers them; None if it does not
    first : the number of a film's first picture; None where the file leaves that open
    time_s : (T,) float array [s]; None if the file has no times
    size : width and height of the picture [px]; None if the file does not say
    rate : frames per second; None if the file does not say
    shift : what to add to the file's pixels to have the first one's centre at (0.5, 0.5)
    """

    choices: dict[str, np.ndarray]
    names: Sequence[str]
    confidence: np.ndarray
    frame: np.ndarray | None = None
    first: int | None = 0
    time_s: np.ndarray | None = None
    size: tuple[float, float] | None = None
    rate: Fraction | None = None
    shift: float = 0.0


def tracker_of(path: str | Path, count: int) -> str:
    """Return the tracker that finds so many points.

    Raises
    ------
    errors.InputError
        if none is known
    """
    if count not in TRACKERS:
        known = ", ".join(f"{count} ({tracker})" for count, tracker in TRACKERS.items())
        message = f"holds {count} points of a face, known are {known}"
        raise errors.InputError(path, message + ": export all of them")
    return TRACKERS[count]


def in_pixels(points: np.ndarray, size: tuple[float, float] | None) -> np.ndarray:
    """Return (T, P, 2) points in pixels; those of a normalised picture need its size.

    Raises
    ------
    ValueError
        if they are normalised and the size is not known
    """
    if not np.isfinite(points).any() or np.nanmedian(points) >= NORMALISED:
        return points
    if size is None:
        raise ValueError("its coordinates are shares of a picture whose size is not known")
    return points * np.array(size, float)


def check_frames(path: str | Path, frame: np.ndarray, places: Sequence[str]) -> None:
    """Refuse frame numbers that do not rise, naming the place of the first such row."""
    if (wrong := np.flatnonzero(np.diff(frame) < 1)).size:
        row = int(wrong[0]) + 1
        if frame[row] == frame[row - 1]:
            message = f"{places[row]}: frame {frame[row]} stands twice: keep one face a frame"
        else:
            message = f"{places[row]}: frame {frame[row]} follows {frame[row - 1]}: sort the rows"
        raise errors.InputError(path, message)
