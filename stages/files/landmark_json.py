"""Landmarks in JSON, as scripts round face trackers write them: a list of frames.

A frame is a list of points, or an object with `landmarks` (or `faceLandmarks`, `face_landmarks`,
`multiFaceLandmarks`, ...) and perhaps its number and time. Points are objects with x and y, lists
of two or three numbers, or one flat list of threes; they may stand in a list of faces, of which
there must be one. Nothing, or an empty list, is a frame on which no face was found. The file may be
a list of frames, an object that holds one, an object with a frame under each number, or have a
frame on each line. Beside the frames it may state `fps`, `width` and `height`.
"""

import dataclasses
import re
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from stages.core import frame_clock
from stages.files import errors, headed_text, json_stream, landmark_take

LANDMARKS = ("landmarks", "facelandmarks", "multifacelandmarks", "landmark", "keypoints", "points")
FACES = ("faces", "face", "results", "result")
FRAMES = ("frames", "data", "results", "detections", *LANDMARKS, "face_landmarks", "faceLandmarks")
INSIDE = ("metadata", "meta", "video", "info", "header")
NUMBER = (*headed_text.FRAME, "frameid", "framenumber", "framenum", "index")
RATE = ("fps", "framerate", "rate")
WIDTH, HEIGHT = ("width", "imagewidth", "framewidth"), ("height", "imageheight", "frameheight")
CONFIDENCE = ("confidence", "score", "facescore")
DIMENSIONS = (3, 2)
PLAIN = re.compile(r"\d{1,18}(\.\d{1,18})?")  # numbers that were written as text
FASTEST = 1000  # frames per second
LARGEST = 1e18  # more than microseconds of today


@dataclasses.dataclass(frozen=True)
class Frame:
    """A frame: its number, time and unit if it has them, its points (P, 2) if any."""

    number: int | None
    time: float | None
    unit_s: float | None
    points: np.ndarray | None
    confidence: float


def read(path: str | Path) -> landmark_take.LandmarkTake:
    """Read a take.

    Raises
    ------
    errors.InputError
        naming the frame that cannot be read
    """
    about: dict[str, Any] = {}
    frames: list[Frame] = []
    for key, value in json_stream.items(path, FRAMES):
        if key and not key.isdecimal() and json_stream.plain(key) not in LANDMARKS:
            about |= {json_stream.plain(key): value}
            if key.lower() in INSIDE and isinstance(value, dict):
                about |= {json_stream.plain(name): one for name, one in value.items()}
            continue
        try:
            frame = _frame(value)
        except (TypeError, ValueError, KeyError, OverflowError) as error:
            message = f"frame {len(frames)} of the file: {error}"
            raise errors.InputError(path, message + ": export one face a frame") from error
        if isinstance(value, dict):
            size = {name: one for name, one in _plainly(value).items() if name in WIDTH + HEIGHT}
            about = size | about
        frames.append(dataclasses.replace(frame, number=int(key)) if key.isdecimal() else frame)
    try:
        return _take(path, frames, about)
    except errors.InputError:
        raise
    except ValueError as error:
        raise errors.InputError(path, f"{error}: export it again") from error


def _plainly(value: dict) -> dict[str, Any]:
    """Return an object by plain keys."""
    return {json_stream.plain(key): one for key, one in value.items()}


def _first(about: dict[str, Any], keys: Sequence[str]) -> Any:
    """Return the first value that an object has under one of some plain keys."""
    return next(
        (about[key] for key in map(json_stream.plain, keys) if about.get(key) is not None), None
    )


def _number(about: dict[str, Any], keys: Sequence[str]) -> float | None:
    """Return a finite number under one of some keys, if there is one."""
    found = _first(about, keys)
    if isinstance(found, str) and PLAIN.fullmatch(found):
        found = float(found)
    if isinstance(found, bool) or not isinstance(found, int | float):
        return None
    if not abs(found) < LARGEST:
        raise ValueError(f"{keys[0]} is no sensible number")
    return float(found)


def _frame(value: Any) -> Frame:
    """Return a frame as it is written."""
    if not isinstance(value, dict):
        return Frame(None, None, None, _face(value), 1.0)
    about = _plainly(value)
    found = _first(about, LANDMARKS)
    points = _face(found if found is not None else _first(about, FACES))
    number, time, unit_s = _number(about, NUMBER), None, None
    for key in value:
        is_time, unit = headed_text.time_unit(key)
        if is_time and time is None:
            time, unit_s = _number(about, [key]), unit
    confidence = _number(about, CONFIDENCE)
    whole = None if number is None else round(number)
    if whole != number:
        raise ValueError(f"{number:g} is no number of a frame")
    return Frame(whole, time, unit_s, points, 1.0 if confidence is None else confidence)


def _face(value: Any) -> np.ndarray | None:
    """Return the points (P, 2) of the one face, NaN where there is none."""
    if not value:
        return None
    if isinstance(value, dict):
        about = _plainly(value)
        return _face(_first(about, (*LANDMARKS, *FACES)))
    first = value[0]
    if isinstance(first, dict) and "x" in first:
        return np.array([(point["x"], point["y"]) for point in value], float)
    if isinstance(first, int | float):
        for count in DIMENSIONS:
            if len(value) // count in landmark_take.TRACKERS and len(value) % count == 0:
                return np.array(value, float).reshape(-1, count)[:, :2]
        raise ValueError(f"{len(value)} numbers are no known set of points")
    if isinstance(first, list) and len(first) in DIMENSIONS and not isinstance(first[0], list):
        return np.array([point[:2] for point in value], float)
    if len(value) > 1:
        raise ValueError(f"{len(value)} faces in one frame")
    return _face(first)


def _take(
    path: str | Path, frames: Sequence[Frame], about: dict[str, Any]
) -> landmark_take.LandmarkTake:
    """Put frames together."""
    known = [frame.points for frame in frames if frame.points is not None]
    if not known:
        message = f"holds no landmarks in its {len(frames)} frames: export the points of the face"
        raise errors.InputError(path, message)
    counts = sorted({len(points) for points in known})
    if len(counts) > 1:
        message = f"has frames of {counts[0]} and of {counts[-1]} points: export all alike"
        raise errors.InputError(path, message)
    tracker = landmark_take.tracker_of(path, counts[0])
    lost = np.full(known[0].shape, np.nan)
    points = np.stack([lost if frame.points is None else frame.points for frame in frames])
    found = np.array([frame.points is not None for frame in frames])
    confidence = np.array([frame.confidence for frame in frames])
    return landmark_take.LandmarkTake(
        {tracker: points},
        [],
        np.where(found, np.clip(confidence, 0.0, 1.0), 0.0),
        frame=_numbers(path, frames),
        time_s=_times(path, frames),
        size=_size(about),
        rate=_rate(about),
    )


def _numbers(path: str | Path, frames: Sequence[Frame]) -> np.ndarray | None:
    """Return the frames' numbers, if they have them."""
    if any(frame.number is None for frame in frames):
        return None
    numbers = np.array([frame.number for frame in frames], np.int64)
    places = [f"frame {row} of the file" for row in range(len(frames))]
    landmark_take.check_frames(path, numbers, places)
    return numbers


def _times(path: str | Path, frames: Sequence[Frame]) -> np.ndarray | None:
    """Return the frames' times [s], if they have them."""
    if any(frame.time is None for frame in frames):
        return None
    times = np.array([frame.time for frame in frames])
    if (wrong := np.flatnonzero(np.diff(times) <= 0)).size:
        message = f"frame {wrong[0] + 1} of the file: its time {times[wrong[0] + 1]:g} does not"
        raise errors.InputError(path, message + " follow the one before: sort the frames")
    unit_s = frames[0].unit_s
    return frame_clock.seconds(times) if unit_s is None else times * unit_s


def _size(about: dict[str, Any]) -> tuple[float, float] | None:
    """Return the size of the picture, if it is stated."""
    width, height = _number(about, WIDTH), _number(about, HEIGHT)
    return (width, height) if width and height else None


def _rate(about: dict[str, Any]) -> Fraction | None:
    """Return the frames per second, if they are stated."""
    rate = _number(about, RATE)
    return frame_clock.snapped(rate) if rate and 0 < rate < FASTEST else None
