"""Curves of a facial performance as a file holds them, under canonical names."""

import dataclasses
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from stages.files import shape_names

# channels of other programs that are known and mean no motion
STILL = ("_neutral", "blendshapecount")


@dataclasses.dataclass(frozen=True)
class CurveTake:
    """Curves as read: a row for each row of the file.

    Attributes
    ----------
    curves : canonical name -> (T,) float array, NaN where there is no value
    unknown : channels of the file that have no canonical name
    time_s : (T,) float array, rising [s]; None if the file has no times
    frame : (T,) int array, rising; None if the file does not number its rows
    rate : frames per second; None if the file does not say
    midnight : whether the times count from midnight, as timecodes do
    angles : `head` and `eye_left`, `eye_right` -> (T, 3) float array, turns about y, x and z of the
        face: to the subject's left, downwards, to the subject's right shoulder [rad]
    """

    curves: dict[str, np.ndarray]
    unknown: list[str]
    time_s: np.ndarray | None
    frame: np.ndarray | None = None
    rate: Fraction | None = None
    midnight: bool = False
    angles: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)


def gather(
    table: Sequence[shape_names.Shape], names: Sequence[str], values: np.ndarray
) -> tuple[dict[str, np.ndarray], list[str]]:
    """Bring channels under canonical names.

    A shape that the file splits is the mean of its parts; one that it shares goes to all that
    share it.

    Parameters
    ----------
    table : the canonical shapes
    names : C channels in any spelling
    values : (T, C) float array

    Returns
    -------
    canonical name -> (T,) array in the table's order, and the channels without a canonical name
    """
    parts: dict[str, list[np.ndarray]] = {}
    unknown = []
    for name, channel in zip(names, values.T, strict=True):
        found = shape_names.names_of(table, name)
        if not found and name.lower() not in STILL:
            unknown.append(name)
        for canonical in found:
            parts.setdefault(canonical, []).append(channel)
    curves = {
        shape.name: np.mean(parts[shape.name], axis=0) for shape in table if shape.name in parts
    }
    return curves, unknown
