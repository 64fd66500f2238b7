"""The points of the shots in which a person picked an actor's extremes."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stages.files import errors, expressions, layer_points


class PickedFrames(NamedTuple):
    """Hold the points of shots from which frames were picked.

    Attributes
    ----------
    layout : the points of all these shots
    offsets : shot -> (T, D) float array [face units], NaN where not observed
    frames : shot -> frame -> its row
    known : names of all points of all basis shots, of either kind
    """

    layout: layer_points.Layout
    offsets: dict[str, np.ndarray]
    frames: dict[str, dict[int, int]]
    known: set[str]


def read(
    paths: Sequence[str | Path],
    shots: Sequence[str],
    points: str,
    picked: Sequence[expressions.Picked],
) -> PickedFrames:
    """Read the points of the shots that are named in a table of expressions.

    Parameters
    ----------
    paths : an expression for each shot
    shots : names of the actor's basis shots
    points : `video`, `markers` or `both`
    picked : the rows of the table

    Raises
    ------
    errors.InputError
        if the lists differ in length, or a shot that is named lacks the points
    """
    if len(paths) != len(shots):
        message = f"{len(shots)} names for {len(paths)} expressions: give one for each"
        raise errors.InputError("--shots", message)
    path_of = dict(zip(shots, paths, strict=True))
    named = [shot for shot in shots if any(row.shot == shot for row in picked)]
    found = {shot: layer_points.read(path_of[shot], points) for shot in named}
    layout = layer_points.joined(each.layout for each in found.values())
    return PickedFrames(
        layout,
        {shot: layer_points.flat(each, layout) for shot, each in found.items()},
        {
            shot: {int(frame): row for row, frame in enumerate(each.frame)}
            for shot, each in found.items()
        },
        {name for path in paths for name in layer_points.known_names(path)},
    )


def offset_of(points: PickedFrames, row: expressions.Picked) -> np.ndarray:
    """Return the offsets (D,) on the frame of an extreme."""
    return points.offsets[row.shot][points.frames[row.shot][row.frame]]
