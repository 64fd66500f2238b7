"""The points of an actor's basis shots, as differences from the neutral, on principal axes."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import partial_projection, pca
from stages.files import driving_points, errors

# of the values of a frame that must have been observed for it to be of use, and of a point's frames
ENOUGH = 0.5
# principal components need no more frames than these, taken evenly
MOST_FRAMES = 20_000


@dataclasses.dataclass(frozen=True)
class ActorPoints:
    """What the basis shots say of the points.

    Attributes
    ----------
    names : the P points of the first shot that are observed on half of the frames
    shots : shot -> its row of each frame number
    offsets : (T, P D) float array [face units], differences from the shot's neutral, NaN where not
        observed; all shots in turn
    confidence : (T,) float array, 0..1
    time_s : (T,) float array [s]
    """

    names: list[str]
    shots: dict[str, dict[int, int]]
    offsets: np.ndarray
    confidence: np.ndarray
    time_s: np.ndarray


def offsets_of(driving: driving_points.DrivingPoints, names: Sequence[str]) -> np.ndarray:
    """Return (T, P D) differences of points from the neutral, NaN where there is no such point."""
    found = np.full((len(driving.frame), len(names), driving.points.shape[2]), np.nan)
    for place, name in enumerate(names):
        if name in driving.names:
            index = driving.names.index(name)
            found[:, place] = driving.points[:, index] - driving.neutral[index]
    return found.reshape(len(found), -1)


def observed_share(offsets: np.ndarray) -> np.ndarray:
    """Return the share (T,) of a frame's values that were observed."""
    return np.isfinite(offsets).mean(axis=1)


def read(paths: Sequence[str | Path], shots: Sequence[str], kind: str) -> ActorPoints:
    """Read the `markers` or `video` points of several shots.

    Raises
    ------
    errors.InputError
        if the lists differ in length, a shot has no such points, or no point is observed enough
    """
    if len(paths) != len(shots):
        message = f"{len(shots)} names for {len(paths)} expressions: give one for each"
        raise errors.InputError("--shots", message)
    parts = [driving_points.read(path, kind) for path in paths]
    names = parts[0].names
    offsets = np.concatenate([offsets_of(part, names) for part in parts])
    often = np.isfinite(offsets).mean(axis=0).reshape(len(names), -1).min(axis=1) >= ENOUGH
    if not often.any():
        message = f"no point of {', '.join(shots)} is observed on half of the frames"
        raise errors.InputError(paths[0], message + ": mend the capture or choose other shots")
    rows, first = {}, 0
    for shot, part in zip(shots, parts, strict=True):
        rows[shot] = {int(frame): first + row for row, frame in enumerate(part.frame)}
        first += len(part.frame)
    return ActorPoints(
        [name for name, kept in zip(names, often, strict=True) if kept],
        rows,
        offsets[:, np.repeat(often, offsets.shape[1] // len(names))],
        np.concatenate([part.confidence for part in parts]),
        np.concatenate([part.time_s for part in parts]),
    )


def axes(
    path: str | Path, points: ActorPoints, min_confidence: float, count: int
) -> tuple[pca.Pca, float]:
    """Find the principal axes of the frames that are whole and sure, and the noise off them.

    Parameters
    ----------
    path : the first expression, for the error
    points : what the shots say
    min_confidence : frames of lower confidence are left out
    count : axes to keep, at most

    Raises
    ------
    errors.InputError
        if fewer than two frames are whole and sure
    """
    sure = np.nan_to_num(points.confidence) >= min_confidence
    usable = np.flatnonzero(sure & np.isfinite(points.offsets).all(axis=1))
    if len(usable) < 2:
        message = f"{len(usable)} of {len(sure)} frames have all points and confidence"
        cure = "fill gaps of markers, or lower min_confidence"
        raise errors.InputError(path, f"{message} {min_confidence}: {cure}")
    step = -(-len(usable) // MOST_FRAMES)
    fitted = pca.fit(points.offsets[usable[::step]])
    if len(fitted.variance) == 0:
        raise errors.InputError(path, "the points never move: is this the right shot?")
    return partial_projection.truncate(fitted, count)
