"""Curves in JSON: a list of frames with the weights of their shapes.

A frame is an object of weights by name, or has one under `blendShapes`, `weights` or the like; or
MediaPipe's list of categories with their scores; or a list of numbers in the order of a list of
names beside the frames (`facsNames` and `weightMat` of Audio2Face, among others). Frames may have a
number and a time. Nothing, or an empty list, is a frame on which no face was found; a shape that a
frame leaves out is 0.
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from stages.core import frame_clock
from stages.files import curve_take, errors, headed_text, json_stream, shape_names

FRAMES = (
    *("frames", "data", "results", "samples", "weights", "weightMat", "values", "blendshapes"),
    *("blendShapes", "faceBlendshapes", "face_blendshapes", "blendshapeFrames"),
)
WEIGHTS = (
    *("blendshapes", "weights", "faceblendshapes", "values", "curves", "shapes", "categories"),
    *("channels", "coefficients", "blendshapeweights"),
)
NAMES = ("names", "facsnames", "blendshapenames", "shapenames", "channels", "channelnames")
FASTEST = 1000  # frames per second
LARGEST = 1e18  # more than microseconds of today
RATE = ("fps", "framerate", "rate", "exportfps")
CATEGORY, SCORE = ("categoryname", "name", "displayname"), ("score", "value", "weight")
NUMBER = (*headed_text.FRAME, "frameid", "framenumber", "framenum", "index")


def read(path: str | Path, table: Sequence[shape_names.Shape]) -> curve_take.CurveTake:
    """Read a take.

    Raises
    ------
    errors.InputError
        naming the frame that cannot be read, or if there are no weights
    """
    about: dict[str, Any] = {}
    names: list[str] = []
    frames: list[Any] = []
    for key, value in json_stream.items(path, FRAMES):
        if not key and isinstance(value, str):
            names.append(value)
        elif key:
            about[json_stream.plain(key)] = value
        else:
            frames.append(value)
    listed = next((about[key] for key in NAMES if isinstance(about.get(key), list)), names)
    rows, numbers, times = [], [], []
    unit_s = None
    for place, value in enumerate(frames):
        try:
            rows.append(_weights(value, listed))
            number, time, unit = _keys(value)
        except (TypeError, ValueError, KeyError, OverflowError) as error:
            raise errors.InputError(path, f"frame {place} of the file: {error}") from error
        numbers.append(number)
        times.append(time)
        unit_s = unit_s or unit
    curves, unknown = _curves(path, rows, table)
    return curve_take.CurveTake(
        curves,
        unknown,
        _times(path, times, unit_s),
        _rising(path, numbers, "number"),
        _rate(about),
    )


def _keys(value: Any) -> tuple[float | None, float | None, float | None]:
    """Return a frame's number, its time, and the time's unit [s] if it is stated."""
    number = time = unit_s = None
    for key, one in value.items() if isinstance(value, dict) else ():
        is_time, unit = headed_text.time_unit(key)
        if not isinstance(one, int | float):
            continue
        if is_time and time is None:
            time, unit_s = float(one), unit
        elif json_stream.plain(key) in map(json_stream.plain, NUMBER) and number is None:
            number = float(one)
    return number, time, unit_s


def _weights(value: Any, names: Sequence[str]) -> dict[str, float]:
    """Return the weights of a frame by the file's names; nothing where no face was found."""
    if not value:
        return {}
    if isinstance(value, list):
        if isinstance(value[0], int | float):
            if len(value) != len(names):
                raise ValueError(f"has {len(value)} weights for {len(names)} names: correct them")
            return dict(zip(names, map(float, value), strict=True))
        if isinstance(value[0], dict) and {json_stream.plain(key) for key in value[0]} & set(
            CATEGORY
        ):
            return dict(map(_category, value))
        if len(value) > 1:
            raise ValueError(f"has {len(value)} faces: keep one")
        return _weights(value[0], names)
    plain = {json_stream.plain(key): one for key, one in value.items()}
    for key in WEIGHTS:
        if isinstance(plain.get(key), list | dict):
            return _weights(plain[key], names)
    others = {json_stream.plain(key) for key in NUMBER}
    return {
        key: float(one)
        for key, one in value.items()
        if isinstance(one, int | float)
        and not headed_text.time_unit(key)[0]
        and json_stream.plain(key) not in others
    }


def _category(value: dict) -> tuple[str, float]:
    """Return name and weight of one of MediaPipe's categories."""
    plain = {json_stream.plain(key): one for key, one in value.items()}
    name = next((plain[key] for key in CATEGORY if plain.get(key)), "")
    score = next((plain[key] for key in SCORE if key in plain), None)
    if score is None:
        raise ValueError(f"'{name}' has no score: export the categories with their scores")
    return str(name), float(score)


def _curves(
    path: str | Path, rows: Sequence[dict[str, float]], table: Sequence[shape_names.Shape]
) -> tuple[dict[str, np.ndarray], list[str]]:
    """Return the curves of all frames, NaN on those without a face."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    lost = [math.nan] * len(names)
    values = np.array([[row.get(name, 0.0) for name in names] if row else lost for row in rows])
    if np.isinf(values).any():
        raise errors.InputError(path, "holds weights that are not finite: export it again")
    known: tuple[dict[str, np.ndarray], list[str]] = ({}, [])
    if names:
        known = curve_take.gather(table, names, values)
    if not known[0]:
        message = f"holds no weights of known names in its {len(rows)} frames: give a list of"
        raise errors.InputError(path, message + " frames with weights such as jawOpen")
    return known


def _times(
    path: str | Path, times: Sequence[float | None], unit_s: float | None
) -> np.ndarray | None:
    """Return the times of the frames [s], if they have them."""
    found = _rising(path, times, "time")
    if found is None:
        return None
    return found * unit_s if unit_s else frame_clock.seconds(found)


def _rising(path: str | Path, keys: Sequence[float | None], what: str) -> np.ndarray | None:
    """Return what every frame has, if it has; refuse it if it does not rise."""
    if not keys or any(key is None for key in keys):
        return None
    found = np.array(keys)
    if (absurd := np.flatnonzero(~(np.abs(found) < LARGEST))).size:
        message = f"frame {absurd[0]} of the file: its {what} is {found[absurd[0]]:g}"
        raise errors.InputError(path, message + ": export it again")
    if (wrong := np.flatnonzero(~(np.diff(found) > 0))).size:
        message = f"frame {wrong[0] + 1} of the file: its {what} {found[wrong[0] + 1]:g} does not"
        raise errors.InputError(path, message + " follow the one before: sort the frames")
    return found


def _rate(about: dict[str, Any]) -> Fraction | None:
    """Return the frames per second, if they are stated."""
    rate = next((about[key] for key in RATE if isinstance(about.get(key), int | float)), 0)
    return frame_clock.snapped(rate) if 0 < rate < FASTEST else None
