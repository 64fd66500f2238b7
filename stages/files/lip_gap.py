"""The distance between points of an expression in pairs: of the lips, which shows lip closures."""

from pathlib import Path

import numpy as np

from stages.files import errors, series


def read(
    path: str | Path, pair: str, frame: np.ndarray, flag: str = "--lip-points"
) -> np.ndarray | None:
    """Read the distance of two points or markers, or the mean of several such distances.

    Parameters
    ----------
    path : expression.parquet
    pair : `upper,lower`, the names of the two, or several pairs with semicolons between; an empty
        text asks nothing
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
    pairs = [[name.strip() for name in each.split(",")] for each in pair.split(";")]
    for each, names in zip(pair.split(";"), pairs, strict=True):
        if len(names) != 2 or names[0] == names[1]:
            message = f"'{each}' is no pair: name two points with a comma between"
            raise errors.InputError(flag, f"{message}, or leave it empty")
    expression = series.read(path, "expression")
    if not np.array_equal(expression.frame, frame):
        message = f"its {len(expression.frame)} frames are not the {len(frame)} of the solution"
        raise errors.InputError(path, message + ": run align_head and the solve again")
    return np.mean([_distance(expression, path, names, flag) for names in pairs], axis=0)


def _distance(
    expression: series.Series, path: str | Path, names: list[str], flag: str
) -> np.ndarray:
    """Return the distance (T,) of two points of one kind."""
    for axes in ("xy", "xyz"):
        if set(names) <= set(series.point_names(expression, axes)):
            upper, lower = np.moveaxis(series.stack(expression, path, names, axes), 1, 0)
            return np.linalg.norm(upper - lower, axis=1)
    message = f"has no two points {' and '.join(names)} of one kind: see {flag}"
    raise errors.InputError(path, message)
