"""How rigid each marker is, from the clip alone: by the distances between markers.

A distance between two markers does not change with the head. Markers that keep their distances from
each other, and under whose motion most of the face moves least, are the core; how far each marker
strays from its place among them is its deviation, and a single observation that is off among the
core is a mistracked one.
"""

import numpy as np

from stages.core import rigid_motion

SAMPLE = 600  # frames, as many as the statistics need
CORE_SHARE = 0.35
CORE_ROUNDS = 5
PROPOSAL_FRAMES = 100
REFERENCES = 16  # core markers that judge one observation
CHUNK = 256  # frames
OFF = 8.0  # times the usual change of distances
ROUNDS = 3
POWER = 1.5
FLOOR = 1e-3  # face units: no marker is known better than this


def fit(
    points: np.ndarray, neutral: np.ndarray, origin: int | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Fit a rigid motion to every frame, with the weights of the clip's own rigidity.

    Minimises, for each frame, `sum_p v_tp |x_p - R n_p - t|^2 / s_p^(2 q)`, where `s_p` is the
    deviation of the marker over the clip, `v_tp` is zero for observations that are off among the
    core and else one. Motion of the face is shared by neighbours, so that a marker that deviates
    counts for less than its square says: `q` is a little above one.

    Parameters
    ----------
    points : (T, P, 3) float array [face units]; NaN where not observed
    neutral : (P, 3) float array [face units]
    origin : row of the point that is moved to the origin; None takes the weighted centroid

    Returns
    -------
    rotation : (T, 3, 3) float array; NaN where it cannot be told
    translation : (T, 3) float array [face units]

    Raises
    ------
    ValueError
        if no frame has enough points
    """
    core = core_markers(_sample(points), neutral)
    votes = observations(points, neutral, core)
    deviation = clip_deviation(_sample(points), neutral, _sample(votes), core)
    weights = votes / deviation ** (2 * POWER)
    return rigid_motion.fit(points, neutral, weights, origin)


def changes_of_distance(points: np.ndarray, neutral: np.ndarray) -> np.ndarray:
    """Return the mean squares (P, P) of the changes of the distances from the neutral's.

    Changes from the neutral's distances, not variances: a marker that stays away from its place
    on the neutral for the whole clip is of no use for a fit to the neutral. NaN on the diagonal
    and where two markers are never observed together.
    """
    count = len(neutral)
    squares = np.full((count, count), np.nan)
    for p in range(count):
        usual = np.linalg.norm(neutral - neutral[p], axis=1)
        change = np.linalg.norm(points - points[:, [p]], axis=2) - usual
        known = np.isfinite(change)
        number = known.sum(axis=0)
        total = np.where(known, change, 0.0) ** 2
        squares[p] = np.where(number > 0, total.sum(axis=0) / np.maximum(number, 1), np.nan)
    np.fill_diagonal(squares, np.nan)
    return squares


def core_markers(points: np.ndarray, neutral: np.ndarray) -> np.ndarray:
    """Return the rows of the markers that are rigid to each other, the most rigid first.

    Each marker with those that keep their distances from it best is one proposal of a head. The
    proposal under whose motion the middle one of all markers moves least wins: a jaw is as rigid
    in itself, but under its motion most of the face moves.

    Parameters
    ----------
    points : (T, P, 3) float array [face units]; NaN where not observed
    neutral : (P, 3) float array [face units]

    Raises
    ------
    ValueError
        if fewer than four markers are observed together
    """
    squares = changes_of_distance(points, neutral)
    np.fill_diagonal(squares, 0.0)
    size = max(rigid_motion.MIN_POINTS, round(CORE_SHARE * len(neutral)))
    best, least = None, np.inf
    few = points[:: max(1, len(points) // PROPOSAL_FRAMES)]
    for near in np.argsort(squares, axis=1, kind="stable"):
        motion = _mean_residual(few, neutral, near[: max(rigid_motion.MIN_POINTS, size // 2)])
        if (middle := np.median(motion)) < least:
            best, least = motion, middle
    if best is None:
        raise ValueError(f"fewer than {rigid_motion.MIN_POINTS} markers are observed together")
    for _ in range(CORE_ROUNDS):
        core = np.argsort(best, kind="stable")[:size]
        best = _mean_residual(points, neutral, core)
    return core[np.isfinite(best[core])]


def _mean_residual(points: np.ndarray, neutral: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return how far each marker strays on average (P,) under the motion of some.

    Infinite where it is never observed together with them.
    """
    weights = np.isin(np.arange(len(neutral)), chosen).astype(float)
    motion = rigid_motion.fit(points, neutral, weights)
    squares = rigid_motion.squared_residuals(points, neutral, *motion)
    known = np.isfinite(squares)
    number = known.sum(axis=0)
    mean = np.sqrt(np.where(known, squares, 0.0)).sum(axis=0) / np.maximum(number, 1)
    return np.where(number > 0, mean, np.inf)


def observations(points: np.ndarray, neutral: np.ndarray, core: np.ndarray) -> np.ndarray:
    """Tell the observations that are in place among the core from those that are off.

    Parameters
    ----------
    points : (T, P, 3) float array; NaN where not observed
    neutral : (P, 3) float array
    core : rows of the rigid markers, the most rigid first

    Returns
    -------
    (T, P) bool array
    """
    judges = core[:REFERENCES]
    apart = np.linalg.norm(neutral[:, None] - neutral[judges], axis=2)
    apart[judges, np.arange(len(judges))] = np.nan
    change = np.empty(points.shape[:2])
    for start in range(0, len(points), CHUNK):
        part = points[start : start + CHUNK]
        distance = np.linalg.norm(part[:, :, None] - part[:, None, judges], axis=3)
        change[start : start + CHUNK] = median(np.abs(distance - apart))
    usual = median(_sample(change).T)
    usual = np.fmax(usual, np.nanmedian(usual[core]))
    return change <= OFF * np.maximum(usual, FLOOR)


def clip_deviation(
    points: np.ndarray, neutral: np.ndarray, votes: np.ndarray, core: np.ndarray
) -> np.ndarray:
    """Estimate each marker's deviation from its place on the neutral.

    The root mean square of `R'(x_p - t) - n_p`, with the motion first from the core, then from
    all markers weighted by the inverse squares of the deviations so found. None is taken for less
    than half of what is usual in the core.

    Parameters
    ----------
    points : (T, P, 3) float array [face units]; NaN where not observed
    neutral : (P, 3) float array [face units]
    votes : (T, P) bool array, which observations count
    core : rows of the rigid markers

    Returns
    -------
    (P,) float array [face units]; infinite where never observed
    """
    weights = np.isin(np.arange(len(neutral)), core).astype(float)
    for _ in range(ROUNDS + 1):
        motion = rigid_motion.fit(points, neutral, votes * weights)
        squares = rigid_motion.squared_residuals(points, neutral, *motion)
        counted = votes & np.isfinite(squares)
        number = counted.sum(axis=0)
        mean = np.where(counted, squares, 0.0).sum(axis=0) / np.maximum(number, 1)
        # else the two or three that happen to fit best would be fitted ever better
        least = max(FLOOR**2, float(np.median(mean[core])) / 4)
        variance = np.where(number > 0, np.maximum(mean, least), np.inf)
        weights = 1 / variance
    return np.sqrt(variance)


def median(values: np.ndarray) -> np.ndarray:
    """Return the median over the last axis of what is known; NaN where nothing is."""
    ordered = np.sort(values, axis=-1)
    number = np.isfinite(values).sum(axis=-1)
    lower, upper = np.maximum(number - 1, 0) // 2, number // 2
    pair = np.stack([lower, np.where(number > 0, upper, 0)], axis=-1)
    return np.take_along_axis(ordered, pair, axis=-1).mean(axis=-1)


def _sample(values: np.ndarray) -> np.ndarray:
    """Return some frames of a long clip, evenly spread."""
    return values[np.unique(np.linspace(0, len(values) - 1, SAMPLE).astype(int))]
