"""The expressions of an actor's basis shots, read as one long performance."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import errors, series


@dataclasses.dataclass(frozen=True)
class Basis:
    """The frames that principal components and key shapes come from.

    Attributes
    ----------
    shot : (T,) array of the shots' names
    frame : (T,) int array
    points : (T, P, 2) float array [face units], NaN where not observed
    confidence : (T,) float array, 0..1, of the frame
    point_confidence : (T, P) float array, 0..1
    names : the P points
    neutral : (P, 2) float array [face units], of the first shot
    """

    shot: np.ndarray
    frame: np.ndarray
    points: np.ndarray
    confidence: np.ndarray
    point_confidence: np.ndarray
    names: list[str]
    neutral: np.ndarray


def read(paths: Sequence[str | Path], shots: Sequence[str]) -> Basis:
    """Read the expressions of several shots, in their order.

    Raises
    ------
    errors.InputError
        if a file lacks a point that the first one has, or the lists differ in length
    """
    if len(paths) != len(shots):
        raise errors.InputError(
            "--shots", f"{len(shots)} names for {len(paths)} expressions: give one for each"
        )
    expressions = [series.read(path, "expression") for path in paths]
    names = expressions[0].meta["points"]
    points, confidence, point_confidence = [], [], []
    for path, expression in zip(paths, expressions, strict=True):
        points.append(series.stack(expression, path, names))
        columns = [f"{name}.confidence" for name in names]
        frame_confidence = expression.columns["confidence"]
        confidence.append(frame_confidence)
        point_confidence.append(
            np.stack([expression.columns.get(c, frame_confidence) for c in columns], axis=1)
        )
    return Basis(
        np.repeat(shots, [len(expression.frame) for expression in expressions]),
        np.concatenate([expression.frame for expression in expressions]),
        np.concatenate(points),
        np.concatenate(confidence),
        np.concatenate(point_confidence),
        names,
        np.array(expressions[0].meta["neutral"], float),
    )


def region_confidence(basis: Basis, chosen: np.ndarray) -> np.ndarray:
    """Return the confidence (T,) of a region: the frame's, or its points' mean if that is lower.

    A frame on which a point of the region was not observed has confidence 0.
    """
    observed = np.isfinite(basis.points[:, chosen]).all(axis=(1, 2))
    mean = basis.point_confidence[:, chosen].mean(axis=1)
    lower = np.minimum(np.nan_to_num(basis.confidence), np.nan_to_num(mean))
    return np.where(observed, lower, 0.0)
