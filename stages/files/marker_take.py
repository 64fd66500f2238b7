"""A take of markers as its file holds it: names, places and what it says of unit and rate."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import errors


@dataclasses.dataclass(frozen=True)
class MarkerTake:
    """Markers in the file's own unit and axes.

    Attributes
    ----------
    names : the P labels, as the file spells them
    points : (T, P, 3) float32 array [file unit], NaN where not observed
    unit : as the file spells it; blank where it states none
    rates : where the file states its rate -> frames per second
    notes : what a person should know of how the file was read
    """

    names: list[str]
    points: np.ndarray
    unit: str
    rates: dict[str, float]
    notes: tuple[str, ...] = ()


def check_names(path: str | Path, names: Sequence[str]) -> None:
    """Refuse a take without markers, or with two of one name."""
    if not names:
        raise errors.InputError(path, "holds no marker: export it again, with labelled markers")
    for name in names:
        if names.count(name) > 1:
            message = f"two markers are labelled '{name}': rename one in the capture software"
            raise errors.InputError(path, message)
