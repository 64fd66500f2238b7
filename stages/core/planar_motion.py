"""Head motion in the picture plane: affine per frame, told apart from the face's own motion.

CB02 extracts an affine motion and applies its translation, rotation and scale. No landmark of a
face is rigid, so each point's motion relative to the head is estimated over the whole clip, and
points that move much (lips, when the jaw opens) count little. This is the clip's own rigidity.
"""

import numpy as np

MIN_POINTS = 4
PAIR_FRAMES = 100  # as many frames as the start needs
ROUNDS = 3
SHEAR_DEVIATION = 0.05  # a head turned by 25 degrees is foreshortened by twice that
PAIRS = 400  # one rigid pair among so many draws is certain enough
FLOOR = 0.01  # face units: no point is known better than this


def _system(
    points: np.ndarray, neutral: np.ndarray, deviation: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the rows (P, 2, 6), normal matrices (T, 6, 6) and right sides (T, 6) of the fit."""
    observed = np.isfinite(points).all(axis=2)
    weights = observed / deviation**2
    target = np.where(observed[..., None], points, 0.0)
    x, y = neutral.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    # unknowns: similarity a, b; stretch c, d; translation. A = [[a + c, d - b], [d + b, a - c]]
    rows = np.stack(
        [np.stack([x, -y, x, y, one, zero], -1), np.stack([y, x, -y, x, zero, one], -1)], 1
    )
    normal = np.einsum("tp,pdi,pdj->tij", weights, rows, rows, optimize=True)
    normal[:, [2, 3], [2, 3]] += 2 / SHEAR_DEVIATION**2
    right = np.einsum("tp,pdi,tpd->ti", weights, rows, target, optimize=True)
    return rows, normal, right


def fit(
    points: np.ndarray, neutral: np.ndarray, deviation: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Fit an affine motion to every frame.

    Minimises, for each frame, `sum_p |x_p - A n_p - t|^2 / s_p^2 + |D|^2 / r^2`, where `D` is the
    part of `A` that is no similarity and `r` its expected size, so that a foreshortened head is
    followed and the stretch of an opening mouth is not.

    Parameters
    ----------
    points : (T, P, 2) float array [face units]; NaN where not observed
    neutral : (P, 2) float array [face units]
    deviation : (P,) float array [face units], expected motion `s_p` of each point on the face

    Returns
    -------
    linear : (T, 2, 2) float array; NaN where fewer than four points are observed
    translation : (T, 2) float array [face units]

    Raises
    ------
    ValueError
        if the shapes disagree
    """
    if points.ndim != 3 or points.shape[1:] != neutral.shape or len(deviation) != len(neutral):
        message = f"points {points.shape}, neutral {neutral.shape}, deviation {deviation.shape}"
        raise ValueError(f"expected (T, P, 2), (P, 2), (P,), got {message}")
    _, normal, right = _system(points, neutral, deviation)
    enough = np.isfinite(points).all(axis=2).sum(axis=1) >= MIN_POINTS
    solution = np.full((len(points), 6), np.nan)
    solution[enough] = np.linalg.solve(normal[enough], right[enough][..., None])[..., 0]
    a, b, c, d, tx, ty = solution.T
    linear = np.stack([np.stack([a + c, d - b], -1), np.stack([d + b, a - c], -1)], 1)
    return linear, np.stack([tx, ty], -1)


def remove(points: np.ndarray, linear: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """Return the points with the motion undone: `A^-1 (x - t)`.

    Parameters
    ----------
    points : (T, P, 2) float array [face units]
    linear : (T, 2, 2) float array
    translation : (T, 2) float array [face units]

    Returns
    -------
    (T, P, 2) float array [face units]; NaN where the motion is unknown
    """
    known = np.isfinite(linear).all(axis=(1, 2))
    inverse = np.full_like(linear, np.nan)
    inverse[known] = np.linalg.inv(linear[known])
    return np.einsum("tij,tpj->tpi", inverse, points - translation[:, None])


def consensus_deviation(points: np.ndarray, votes: np.ndarray, seed: int) -> np.ndarray:
    """Estimate how far each point of a clip moves, by the consensus of most points.

    Two points that are rigid give the similarity of every frame, under which most points stay
    where they usually are. Of many pairs, the one with the least weighted median deviation over
    the points wins (least median of squares, over the clip instead of within a frame), so that a
    jaw whose points move together is outvoted.

    Parameters
    ----------
    points : (T, P, 2) float array; NaN where not observed
    votes : (P,) float array, how much each point counts
    seed : of the draw of pairs

    Returns
    -------
    (P,) float array [unit of the points]
    """
    places = points[..., 0] + 1j * points[..., 1]
    first, second = np.triu_indices(points.shape[1], 1)
    drawn = np.random.default_rng(seed).permutation(len(first))[:PAIRS]
    best, least = np.full(points.shape[1], np.inf), np.inf
    for p, q in zip(first[drawn], second[drawn], strict=True):
        base = places[:, q] - places[:, p]
        usual = np.nanmedian(np.abs(base))
        with np.errstate(divide="ignore", invalid="ignore"):
            seen = (places - places[:, [p]]) / base[:, None] * usual
        middle = np.nanmedian(seen.real, axis=0) + 1j * np.nanmedian(seen.imag, axis=0)
        deviation = np.nanmedian(np.abs(seen - middle), axis=0)
        deviation[~np.isfinite(deviation)] = np.inf
        score = _weighted_median(deviation, votes)
        if score < least:
            best, least = deviation, score
    return best


def _weighted_median(values: np.ndarray, weights: np.ndarray) -> float:
    """Return the value below which half of the weight lies."""
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(reached, reached[-1] / 2)]])


def clip_deviation(
    points: np.ndarray, neutral: np.ndarray, votes: np.ndarray, seed: int
) -> np.ndarray:
    """Estimate how much each point's place on the face is to be distrusted.

    Starts from `consensus_deviation` and repeats it a few times with the motion that it gives.
    The result is the deviation, squared over the median where it is above that: many points of
    one jaw move together, so they must count far less than as many points with errors of their
    own. Below the median it stays honest, so that no few points overrule the expected size of `D`.
    (Estimating the variances by expectation maximisation instead was tried: it assumes errors of
    their own, and ends with the jaw as the head.)

    Parameters
    ----------
    points : (T, P, 2) float array [face units]; NaN where not observed
    neutral : (P, 2) float array [face units]
    votes : (P,) float array, how much each point counts
    seed : of the draw of pairs

    Returns
    -------
    (P,) float array [face units]

    Raises
    ------
    ValueError
        if no frame has enough points
    """
    observed = np.isfinite(points).all(axis=2)
    usable = np.flatnonzero(observed.sum(axis=1) >= MIN_POINTS)
    if len(usable) == 0:
        raise ValueError(f"none of {len(points)} frames has {MIN_POINTS} observed points")
    chosen = np.unique(np.linspace(0, len(usable) - 1, PAIR_FRAMES).astype(int))
    points = points[usable[chosen]]
    deviation = _distrust(consensus_deviation(points, votes, seed))
    for _ in range(ROUNDS):
        face = remove(points, *fit(points, neutral, deviation))
        usual = np.nanmedian(face, axis=0)
        deviation = _distrust(np.nanmedian(np.linalg.norm(face - usual, axis=-1), axis=0))
    return deviation


def _distrust(deviation: np.ndarray) -> np.ndarray:
    """Return the deviations, those above the median squared over it, from the floor up to one."""
    kept = np.clip(np.where(np.isfinite(deviation), deviation, 1.0), FLOOR, 1.0)
    return kept * np.maximum(kept / np.median(kept), 1.0)


def decompose(linear: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Split linear maps into the nearest rotation and a scale.

    `A = R S` by polar decomposition with a proper rotation; the scale is the square root of the
    determinant, which a foreshortened head shrinks, so the larger singular value is taken: the
    direction that the head's turning leaves alone.

    Parameters
    ----------
    linear : (T, 2, 2) float array

    Returns
    -------
    angle : (T,) float array [rad], counter-clockwise, continuous over the frames that are known
    scale : (T,) float array
    """
    a = (linear[:, 0, 0] + linear[:, 1, 1]) / 2
    b = (linear[:, 1, 0] - linear[:, 0, 1]) / 2
    c = (linear[:, 0, 0] - linear[:, 1, 1]) / 2
    d = (linear[:, 1, 0] + linear[:, 0, 1]) / 2
    angle = np.arctan2(b, a)
    known = np.isfinite(angle)
    angle[known] = np.unwrap(angle[known])
    return angle, np.hypot(a, b) + np.hypot(c, d)
