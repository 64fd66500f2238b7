"""The markers of a performance in face units, against those of the session's neutral."""

import dataclasses
from pathlib import Path

import numpy as np

from stages import cli
from stages.files import errors, series

AXES = "xyz"
MISTRACKED = 2  # of `<marker>.repaired`


@dataclasses.dataclass(frozen=True)
class MarkerPoints:
    """Markers of a shot.

    Attributes
    ----------
    names : the P markers that the neutral shows
    points : (T, P, 3) float32 array [face units], NaN where not observed
    neutral : (P, 3) float array [face units]
    mistracked : (T, P) bool array, places that were not measured
    """

    names: list[str]
    points: np.ndarray
    neutral: np.ndarray
    mistracked: np.ndarray


def read(
    performance: series.Series,
    path: str | Path,
    neutral_path: str | Path,
    neutral_frame: int,
    unit_markers: str,
) -> MarkerPoints:
    """Return the markers of a performance that the neutral shows, in face units.

    The face unit is the distance of the two unit markers on the neutral, the origin is midway
    between them.

    Parameters
    ----------
    performance, path : the shot that holds markers, and its file
    neutral_path, neutral_frame : performance of the neutral's shot, and the frame
    unit_markers : two names with a comma between them

    Raises
    ------
    errors.InputError
        if the unit markers are not named or not on the neutral, or the neutral shows no marker
    """
    ends = [name.strip() for name in unit_markers.split(",") if name.strip()]
    if len(ends) != 2:
        found = f"'{unit_markers}'" if ends else "none"
        message = f"holds markers, which need two unit markers, got {found}"
        raise errors.InputError(path, message + ": set unit_markers in sessions.tsv")
    shown = _neutral(neutral_path, neutral_frame)
    for name in ends:
        if name not in shown:
            message = f"unit marker {name} is not seen on the neutral frame {neutral_frame}"
            raise errors.InputError(neutral_path, message + ": see unit_markers in sessions.tsv")
    there = series.point_names(performance, AXES)
    names = [name for name in there if name in shown]
    if missing := [name for name in there if name not in shown]:
        cli.logger.info("left out, not on the neutral: %s", ", ".join(missing))
    if not names:
        message = f"shows none of the markers of {path} on frame {neutral_frame}"
        cure = "choose another neutral_frame, or name them alike by marker_map"
        raise errors.InputError(neutral_path, f"{message}: {cure}")
    origin = (shown[ends[0]] + shown[ends[1]]) / 2
    unit = float(np.linalg.norm(shown[ends[1]] - shown[ends[0]]))
    if unit == 0:
        message = f"the unit markers {ends[0]} and {ends[1]} are at one place on the neutral"
        raise errors.InputError(neutral_path, message + ": see unit_markers in sessions.tsv")
    points = series.stack(performance, path, names, AXES)
    points -= origin.astype(points.dtype)
    points /= points.dtype.type(unit)
    repaired = series.stack(performance, path, names, ["repaired"])[..., 0]
    neutral = (np.array([shown[name] for name in names]) - origin) / unit
    return MarkerPoints(names, points, neutral, repaired == MISTRACKED)


def _neutral(path: str | Path, frame: int) -> dict[str, np.ndarray]:
    """Return the places of the markers that are seen on the neutral [mm]."""
    source = series.read(path, "performance", np.float32)
    names = series.point_names(source, AXES)
    if not names:
        message = "the neutral's shot holds no markers: choose a neutral_shot with markers"
        raise errors.InputError(path, message)
    if frame >= len(source.frame):
        message = f"neutral frame {frame} is beyond the last frame {len(source.frame) - 1}"
        raise errors.InputError(path, message + ": correct neutral_frame in sessions.tsv")
    here = series.Series(
        source.frame[[frame]],
        source.time_s[[frame]],
        {name: values[[frame]] for name, values in source.columns.items()},
        source.rate,
        source.meta,
    )
    places = series.stack(here, path, names, AXES)[0].astype(np.float64)
    repaired = series.stack(here, path, names, ["repaired"])[0, :, 0]
    seen = np.isfinite(places).all(axis=1) & (repaired != MISTRACKED)
    return {name: place for name, place, good in zip(names, places, seen, strict=True) if good}
