"""Key shapes at the centres of clusters (CB02 section 4.2)."""

import numpy as np

from stages.core import key_shape_candidates, pca
from stages.core.key_shape_candidates import Choice

_STARTS = 4
_ROUNDS = 200


def choose(candidates, count, dimensions):
    """Cluster the frames on the first principal axes; take the frame nearest to each centre.

    Minimises ``sum_t min_k |y_t - c_k|^2`` over the centres c, y being the coordinates on the
    first axes; locked frames are centres that stay where they are.

    Parameters
    ----------
    candidates : key_shape_candidates.Candidates
    count : int
        Key shapes, locked ones included.
    dimensions : int
        Axes; the paper reports 2 and 3.

    Returns
    -------
    list of key_shape_candidates.Choice
        Largest cluster first.

    Raises
    ------
    ValueError
        When the count cannot be filled.

    Notes
    -----
    CB02 section 4.2. The centre of mass is no frame, and an artist needs one to look at;
    `centres` gives the centres themselves, for their own error.
    """
    key_shape_candidates.check(candidates, count)
    chosen = key_shape_candidates.locked_choices(candidates)
    points, _, members = _clustered(candidates, count, dimensions)
    for mean, member in sorted(members, key=lambda pair: -np.count_nonzero(pair[1])):
        allowed = key_shape_candidates.free(candidates, chosen)
        distance = np.where(allowed, np.sum((points - mean) ** 2, axis=1), np.inf)
        size = np.count_nonzero(member)
        reason = f"nearest to the centre of a cluster of {size} frames on {dimensions} axes"
        chosen.append(Choice(int(distance.argmin()), reason))
    return chosen


def centres(candidates, count, dimensions):
    """Return the mean shape (count, D) of every cluster; locked frames stand for their own."""
    usable = np.where(np.isfinite(candidates.frames), candidates.frames, 0.0)
    return memberships(candidates, count, dimensions) @ usable


def memberships(candidates, count, dimensions):
    """Return every cluster's share (count, T) of each frame; the rows sum to one."""
    key_shape_candidates.check(candidates, count)
    points, usable, members = _clustered(candidates, count, dimensions)
    shares = np.zeros((count, len(points)))
    shares[range(len(candidates.locked)), list(candidates.locked)] = 1.0
    for row, (_, member) in enumerate(members, start=len(candidates.locked)):
        # a centre that no frame is nearest to lies where they all are
        own = usable[member] if member.any() else usable
        shares[row, own] = 1 / len(own)
    return shares


def _clustered(candidates, count, dimensions):
    """Return points (T, dimensions), the eligible frames, and centre and members of clusters."""
    points = pca.project(candidates.model, candidates.frames)[:, :dimensions]
    usable = np.flatnonzero(candidates.eligible)
    fixed = points[list(candidates.locked)]
    rng = np.random.default_rng(candidates.seed)
    runs = [_lloyd(points[usable], fixed, count, rng) for _ in range(_STARTS)]
    _, means, nearest = min(runs, key=lambda run: run[0])
    numbers = range(len(fixed), count)
    return points, usable, [(means[number], nearest == number) for number in numbers]


def _lloyd(points, fixed, count, rng):
    """Return the cost, centres and nearest centre of one run of k-means from k-means++ seeds."""
    means = _seeds(points, fixed, count, rng)
    nearest = None
    for _ in range(_ROUNDS):
        distance = _squares(points, means)
        before, nearest = nearest, distance.argmin(axis=1)
        if before is not None and (before == nearest).all():
            break
        size = np.bincount(nearest, minlength=count)
        moving = np.flatnonzero(size[len(fixed) :]) + len(fixed)
        for axis in range(points.shape[1]):
            total = np.bincount(nearest, points[:, axis], minlength=count)
            means[moving, axis] = total[moving] / size[moving]
    return distance.min(axis=1).sum(), means, nearest


def _squares(points, means):
    """Return the squared distance (T, count) of every point from every centre."""
    return sum((points[:, [axis]] - means[:, axis]) ** 2 for axis in range(points.shape[1]))


def _seeds(points, fixed, count, rng):
    """Draw centres one by one, each with probability proportional to its squared distance."""
    means = list(fixed) or [points[rng.integers(len(points))]]
    distance = _squares(points, np.array(means)).min(axis=1)
    while len(means) < count:
        total = distance.sum()
        share = distance / total if total > 0 else np.full(len(points), 1 / len(points))
        means.append(points[rng.choice(len(points), p=share)])
        distance = np.minimum(distance, _squares(points, means[-1][None])[:, 0])
    return np.array(means)
