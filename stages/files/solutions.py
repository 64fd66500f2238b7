"""Solutions: what the methods make of a take before it is filled, filtered and limited.

Each has a column for every shape of the rig, `<mask>.<shape>`, NaN where it was not solved, and
`confidence`.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import errors, series

# the limits of what each method solves
LIMITS = {
    "key_weights": (-np.inf, np.inf),
    "mapped": (-np.inf, np.inf),
    "predicted": (0.0, 1.0),
    "solved": (0.0, 1.0),
    "directed": (-np.inf, np.inf),
}


def columns(read: series.Series, path: str | Path, names: Sequence[str]) -> np.ndarray:
    """Return (T, N) values of the named columns.

    Raises
    ------
    errors.InputError
        naming a column that is missing
    """
    for name in names:
        if name not in read.columns:
            raise errors.InputError(path, f"column {name}, which the rig needs, is missing")
    return np.stack([read.columns[name] for name in names], axis=1)


def observed(read: series.Series, path: str | Path, shapes: Sequence[str]) -> np.ndarray:
    """Return (T, K) weights, NaN on frames that were not measured: filled in, without confidence.

    Raises
    ------
    errors.InputError
        naming a column that is missing
    """
    *weights, confidence = columns(read, path, [*shapes, "confidence"]).T
    return np.where((confidence == 0.0)[:, None], np.nan, np.stack(weights, axis=1))
