"""All frames of an actor's basis shots, one after another, as offsets from the neutral."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import coordinate_balance, expression_proposals
from stages.files import errors, layer_points, lip_gap, point_set, series

ENOUGH = 0.5  # of a frame's coordinates that must have been observed
EYE = "eye_"
LEAST_CONTOUR = 4  # points with which a contour of an eye encloses something


@dataclasses.dataclass(frozen=True)
class BasisFrames:
    """The frames of several shots.

    Attributes
    ----------
    shot : (T,) object array, the shot of each frame
    frame : (T,) int array, as counted in its shot
    time_s : (T,) float array [s]
    values : (T, D) float array, offsets from the neutral, kinds of points balanced; what was not
        observed is at its mean
    eligible : (T,) bool array, frames that are sure and observed enough
    """

    shot: np.ndarray
    frame: np.ndarray
    time_s: np.ndarray
    values: np.ndarray
    eligible: np.ndarray


def read(
    paths: Sequence[str | Path], shots: Sequence[str], points: str, min_confidence: float
) -> BasisFrames:
    """Read the frames of several shots.

    Parameters
    ----------
    paths : an expression for each shot
    shots : their names
    points : `video`, `markers` or `both`, of which a shot may have one alone
    min_confidence : frames of less are not eligible

    Raises
    ------
    errors.InputError
        if a shot lacks the points, none of the frames is eligible, or the points never move
    """
    read_shots = [layer_points.read_available(path, points) for path in paths]
    layout = layer_points.joined(each.layout for each in read_shots)
    offsets = np.concatenate([layer_points.flat(each, layout) for each in read_shots])
    sure = np.concatenate([each.confidence for each in read_shots]) >= min_confidence
    eligible = sure & np.concatenate([_enough(each) for each in read_shots])
    if not eligible.any():
        message = f"no frame of {', '.join(shots)} has half of the points and confidence"
        cure = "lower min_confidence, or choose other basis shots"
        raise errors.InputError(paths[0], f"{message} {min_confidence:g}: {cure}")
    values = expression_proposals.filled(offsets)
    try:
        group = layer_points.group_of(layout)
        whole = np.ones((1, values.shape[1]))
        balanced = values * coordinate_balance.factors(values.T, group, whole, "variance")
    except ValueError as error:
        message = "its points never move: is this the right shot?"
        raise errors.InputError(paths[0], message) from error
    return BasisFrames(
        np.repeat(np.array(shots, object), [len(each.frame) for each in read_shots]),
        np.concatenate([each.frame for each in read_shots]),
        np.concatenate([each.time_s for each in read_shots]),
        balanced,
        eligible,
    )


def _enough(points: layer_points.LayerPoints) -> np.ndarray:
    """Return the frames (T,) on which enough of a shot's own points were observed."""
    return np.isfinite(layer_points.flat(points, points.layout)).mean(axis=1) >= ENOUGH


def row_at(frames: BasisFrames, shot: str, time_s: float) -> int:
    """Return the row of a shot's frame nearest to a time; the ends are held."""
    own = np.flatnonzero(frames.shot == shot)
    return int(own[np.abs(frames.time_s[own] - time_s).argmin()])


def eye_opening(path: str | Path, lid_points: str, frame: np.ndarray) -> np.ndarray:
    """Return how far the eyes are open (T,), NaN where that is not observed.

    Parameters
    ----------
    path : expression.parquet
    lid_points : `upper,lower`, whose distance shows it; if empty, the contours of the eyes, in the
        mean of area over width squared
    frame : (T,) int array, the frames of the shot
    """
    if lid_points:
        return lip_gap.read(path, lid_points, frame, "--lid-points")
    expression = series.read(path, "expression")
    contours: dict[str, list[str]] = {}
    for name in series.point_names(expression):
        if name.startswith(EYE):
            contours.setdefault(point_set.contour_of(name), []).append(name)
    openings = [
        expression_proposals.opening_of_contour(series.stack(expression, path, names))
        for names in contours.values()
        if len(names) >= LEAST_CONTOUR
    ]
    if not openings:
        return np.full(len(frame), np.nan)
    return np.mean(openings, axis=0)
