"""A film together with what was tracked in it, picture by picture."""

import dataclasses
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import film, point_set, regions, series

# rows of the contour's points, whether it is closed, number of its region (-1: none)
Outline = tuple[np.ndarray, bool, int]

# shade of a picture without a film, and room beyond points of which the picture is not known
EMPTY = 28
ROOM = 1.1


@dataclasses.dataclass(frozen=True)
class TrackedFilm:
    """What was tracked in a film.

    Attributes
    ----------
    video : path of the film, or an empty text: the points are drawn on an empty picture
    size : width and height of the picture [px]
    rate : pictures per second
    frame, time_s : (T,) arrays, number in the film and time [s] of each tracked frame
    points : (T, P, 2) float array [px], NaN where not observed
    point_confidence : (T, P) float array in 0..1
    confidence : (T,) float array in 0..1
    outlines : the contours
    """

    video: str
    size: tuple[int, int]
    rate: Fraction
    frame: np.ndarray
    time_s: np.ndarray
    points: np.ndarray
    point_confidence: np.ndarray
    confidence: np.ndarray
    outlines: list[Outline]


def read(
    video: str, tracked: str | Path, point_set_path: str | Path, regions_path: str | Path
) -> TrackedFilm:
    """Read what was tracked in a film, and how to draw it.

    Raises
    ------
    errors.InputError
        if one of the tables does not fit
    """
    observed = series.read(tracked, "tracked")
    names = series.point_names(observed)
    points = series.stack(observed, tracked, names)
    point_confidence = series.stack(observed, tracked, names, axes=["confidence"])[:, :, 0]
    confidence = observed.columns["confidence"]
    return TrackedFilm(
        video,
        film.size(video) if video else _size(observed, points),
        film.nominal_rate(video) if video else observed.rate,
        observed.frame,
        observed.time_s,
        points,
        point_confidence,
        confidence,
        _outlines(names, point_set.read(point_set_path), regions.read(regions_path)),
    )


def _outlines(
    names: list[str], contours: list[point_set.Contour], table: regions.Regions
) -> list[Outline]:
    """Return the contours of a point set that were tracked."""
    owners = np.array([point_set.contour_of(name) for name in names])
    outlines = []
    for contour in contours:
        rows = np.flatnonzero(owners == contour.name)
        if not len(rows):
            continue
        own = {contour.name, *(names[row] for row in rows)}
        held = [number for number, members in enumerate(table.values()) if own & set(members)]
        outlines.append((rows, contour.kind == "closed", held[0] if held else -1))
    return outlines


def _size(observed: series.Series, points: np.ndarray) -> tuple[int, int]:
    """Return the size of the picture that the points were found in, or one that holds them."""
    if observed.meta.get("picture_size"):
        width, height = observed.meta["picture_size"]
        return int(width), int(height)
    far = np.nanmax(points.reshape(-1, 2), axis=0, initial=1.0)
    return int(far[0] * ROOM), int(far[1] * ROOM)


def pictures(tracked: TrackedFilm) -> Iterator[tuple[int, np.ndarray]]:
    """Yield row and picture of every tracked frame, in the film's order."""
    if not tracked.video:
        width, height = tracked.size
        for row in range(len(tracked.frame)):
            yield row, np.full((height, width, 3), EMPTY, np.uint8)
        return
    rows = {int(frame): row for row, frame in enumerate(tracked.frame)}
    for number, (_, picture) in enumerate(film.read_frames(tracked.video)):
        if number in rows:
            yield rows[number], picture
