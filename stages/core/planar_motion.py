"""Head motion in the picture plane: affine per frame, told apart from the face's own motion.

CB02 extracts an affine motion and applies its translation, rotation and scale. No landmark of a
face is rigid, so each point's motion relative to the head is estimated over the whole clip, and
points that move much (lips, when the jaw opens) count little. This is the clip's own rigidity
(METHODS of rigid-point selection, applied to planar affine motion).
"""

import numpy as np

MIN_POINTS = 4
FLOOR = 0.01  # face units: no point is known better than this


def _system(
    points: np.ndarray, neutral: np.ndarray, deviation: np.ndarray, shear_deviation: float
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
    normal[:, [2, 3], [2, 3]] += 2 / shear_deviation**2
    right = np.einsum("tp,pdi,tpd->ti", weights, rows, target, optimize=True)
    return rows, normal, right


def fit(
    points: np.ndarray, neutral: np.ndarray, deviation: np.ndarray, shear_deviation: float
) -> tuple[np.ndarray, np.ndarray]:
    """Fit an affine motion to every frame.

    Minimises, for each frame, `sum_p |x_p - A n_p - t|^2 / s_p^2 + |D|^2 / r^2`, where `D` is the
    part of `A` that is no similarity, so that a foreshortened head is followed and the stretch of
    an opening mouth is not.

    Parameters
    ----------
    points : (T, P, 2) float array [face units]; NaN where not observed
    neutral : (P, 2) float array [face units]
    deviation : (P,) float array [face units], expected motion `s_p` of each point on the face
    shear_deviation : expected size `r` of the part of `A` that is no similarity

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
    _, normal, right = _system(points, neutral, deviation, shear_deviation)
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


def clip_deviation(
    points: np.ndarray, neutral: np.ndarray, shear_deviation: float, rounds: int = 30
) -> np.ndarray:
    """Estimate how far each point of a clip moves on the face.

    Expectation maximisation with the motion of every frame as what is hidden: each point's
    variance becomes the mean of its squared distance from the fitted place plus the uncertainty
    of that place. Without the second term a few points would claim to be rigid and drag the
    motion along.

    Parameters
    ----------
    points : (T, P, 2) float array [face units]; NaN where not observed
    neutral : (P, 2) float array [face units]
    shear_deviation : as for `fit`
    rounds : number of alternations

    Returns
    -------
    (P,) float array [face units]

    Raises
    ------
    ValueError
        if no frame has enough points
    """
    observed = np.isfinite(points).all(axis=2)
    usable = observed.sum(axis=1) >= MIN_POINTS
    if not usable.any():
        raise ValueError(f"none of {len(points)} frames has {MIN_POINTS} observed points")
    points, observed = points[usable], observed[usable]
    deviation = np.full(len(neutral), 0.1)
    for _ in range(rounds):
        linear, translation = fit(points, neutral, deviation, shear_deviation)
        rows, normal, _ = _system(points, neutral, deviation, shear_deviation)
        expected = np.einsum("tij,pj->tpi", linear, neutral) + translation[:, None]
        squares = ((points - expected) ** 2).sum(axis=2)
        squares += np.einsum("pdi,tij,pdj->tp", rows, np.linalg.inv(normal), rows, optimize=True)
        mean = np.where(observed, squares, 0).sum(axis=0) / np.maximum(observed.sum(axis=0), 1)
        deviation = np.sqrt(np.where(observed.any(axis=0), mean / 2, 1.0) + FLOOR**2)
    return deviation


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
