"""The points of a shot's expression that drive a rig: its markers, or the points of its film."""

import dataclasses
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import errors, series

AXES = {"markers": "xyz", "video": "xy"}


@dataclasses.dataclass(frozen=True)
class DrivingPoints:
    """What is known of the points on every frame.

    Attributes
    ----------
    frame : (T,) int array
    time_s : (T,) float array [s]
    rate : frames per second
    names : the P points
    points : (T, P, D) float array [face units], NaN where not observed; D is 3 or 2
    neutral : (P, D) float array [face units]
    confidence : (T,) float array, 0..1
    """

    frame: np.ndarray
    time_s: np.ndarray
    rate: Fraction
    names: list[str]
    points: np.ndarray
    neutral: np.ndarray
    confidence: np.ndarray


def read(path: str | Path, kind: str) -> DrivingPoints:
    """Read the `markers` or the `video` points of an expression.

    Raises
    ------
    errors.InputError
        if the shot has no such points
    """
    expression = series.read(path, "expression")
    names, neutral, confidence = {
        "markers": ("markers", "marker_neutral", "markers.confidence"),
        "video": ("points", "neutral", "confidence"),
    }[kind]
    if not expression.meta.get(names):
        message = f"holds no {kind} points: see the column points of cast.tsv"
        raise errors.InputError(path, message)
    return DrivingPoints(
        expression.frame,
        expression.time_s,
        expression.rate,
        expression.meta[names],
        series.stack(expression, path, expression.meta[names], AXES[kind]),
        np.array(expression.meta[neutral], float),
        expression.columns[confidence],
    )
