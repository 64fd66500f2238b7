"""Resample the true contours evenly between their corners, and name their points."""

import numpy as np

# contour: kind, number of points of the point set, number of points that a person labels
POINT_SET = {
    "brow_right": ("open", 7, 9),
    "brow_left": ("open", 7, 9),
    "eye_right": ("closed", 12, 16),
    "eye_left": ("closed", 12, 16),
    "pupil_right": ("point", 1, 1),
    "pupil_left": ("point", 1, 1),
    "lips_outer": ("closed", 20, 28),
    "lips_inner": ("closed", 16, 24),
}


def names(counts=1):
    """Return the names of all points in order; counts 1 for the point set, 2 for the labels."""
    result = []
    for contour, entry in POINT_SET.items():
        single = entry[0] == "point"
        result += [contour] if single else [f"{contour}_{i:02d}" for i in range(entry[counts])]
    return result


def along(line, at):
    """Return points of a polyline at fractions of its length, (N, D)."""
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    length = np.concatenate([[0], np.cumsum(steps)])
    where = np.asarray(at) * length[-1]
    return np.stack([np.interp(where, length, column) for column in line.T], axis=1)


def fractions(kind, count):
    """Return evenly spaced fractions along a contour, or along each half of a closed one."""
    if kind == "point":
        return np.zeros(1)
    if kind == "open":
        return np.linspace(0, 1, count)
    return np.arange(count // 2) / (count // 2)


def sample(kind, dense, at, back=None):
    """Return points of a dense contour at fractions along it.

    Parameters
    ----------
    kind : "open", "closed" or "point"
    dense : (N, D) float array; a closed one has its corners at rows 0 and N / 2
    at : (M,) float array, fractions of an open contour, or of a closed one's first half
    back : (M,) float array, fractions of the second half; as `at` without it

    Returns
    -------
    points : (M, D) float array, (2 M, D) for a closed contour
    """
    if kind == "point":
        return dense[:1]
    if kind == "open":
        return along(dense, at)
    half = len(dense) // 2
    closed = np.concatenate([dense, dense[:1]])
    back = at if back is None else back
    return np.concatenate([along(closed[: half + 1], at), along(closed[half:], back)])


def point_set(dense):
    """Return the points of the point set of dense contours in pixels, (P, 2) [px]."""
    rows = []
    for contour, (kind, count, _) in POINT_SET.items():
        rows.append(sample(kind, dense[contour], fractions(kind, count)))
    return np.concatenate(rows)
