"""Regions: which points of a face belong together, and how much each counts.

A tab-separated table `region, point, weight`. A point may be a contour's name, which stands for
all its points; a later row that names one of them overrides its weight.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.files import delimited, errors, point_set

Regions = dict[str, dict[str, float]]


def read(path: str | Path) -> Regions:
    """Read the regions in the file's order: region -> point or contour -> weight.

    Raises
    ------
    errors.InputError
        naming line and cell
    """
    regions: Regions = {}
    for row in delimited.read(path, ("region", "point", "weight")):
        region, point = row.cells["region"], row.cells["point"]
        weight = delimited.number(path, row, "weight") if row.cells["weight"] else 1.0
        if weight < 0:
            raise errors.InputError(
                path, f"line {row.line}, column weight: {weight} is negative: give 0 or more"
            )
        if point in regions.setdefault(region, {}):
            raise errors.InputError(
                path, f"line {row.line}: {point} stands twice in {region}: remove one"
            )
        regions[region][point] = weight
    return regions


def select(
    path: str | Path, regions: Regions, region: str, points: Sequence[str]
) -> tuple[np.ndarray, np.ndarray]:
    """Return which of a face's points are a region's, and their weights.

    Parameters
    ----------
    path : the table's file, for the error
    regions : as read
    region : one of them
    points : names of the P points of the face

    Returns
    -------
    indices : (Q,) int array, ascending
    weights : (Q,) float array, not negative

    Raises
    ------
    errors.InputError
        if a row names no point of the face, or nothing of the region has weight
    """
    weights = np.zeros(len(points))
    contours = np.array([point_set.contour_of(point) for point in points])
    names = np.array(points)
    rows = regions[region]
    for name in sorted(rows, key=lambda row: row in points):
        chosen = (names == name) | (contours == name)
        if not chosen.any():
            message = f"region {region}: no point or contour of the face is called {name}"
            raise errors.InputError(path, message + "; see the point set")
        weights[chosen] = rows[name]
    indices = np.flatnonzero(weights)
    if len(indices) == 0:
        raise errors.InputError(
            path, f"region {region}: no point has a weight above zero: give one"
        )
    return indices, weights[indices]
