"""The distance between two points of an expression: of the lips, which shows lip closures."""

from pathlib import Path

import numpy as np

from stages.files import errors, series


def read(
    path: str | Path, pair: str, frame: np.ndarray, flag: str = "--lip-points"
) -> np.ndarray | None:
    """Read the distance of two points or markers.

    Parameters
    ----------
    path : expression.parquet
    pair : `upper,lower`, the names of the two; an empty text asks nothing
    frame : (T,) int array, the frames that it must have
    flag : what named the two, for the error

    Returns
    -------
    (T,) float array [face units], NaN where not observed; or None

    Raises
    ------
    errors.InputError
        if these are not two points of the expression, or its frames are others
    """
    if not pair:
        return None
    names = [name.strip() for name in pair.split(",")]
    if len(names) != 2 or names[0] == names[1]:
        message = f"'{pair}' is no pair: name two points with a comma between, or leave it empty"
        raise errors.InputError(flag, message)
    expression = series.read(path, "expression")
    if not np.array_equal(expression.frame, frame):
        message = f"its {len(expression.frame)} frames are not the {len(frame)} of the solution"
        raise errors.InputError(path, message + ": run align_head and the solve again")
    for axes in ("xy", "xyz"):
        known = series.point_names(expression, axes)
        if set(names) <= set(known):
            upper, lower = np.moveaxis(series.stack(expression, path, names, axes), 1, 0)
            return np.linalg.norm(upper - lower, axis=1)
    message = f"has no two points {' and '.join(names)} of one kind: see {flag}"
    raise errors.InputError(path, message)
