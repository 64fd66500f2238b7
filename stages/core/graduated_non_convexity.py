"""Head motion by graduated non-convexity (Geman and McClure's estimator; Blake and Zisserman).

Each frame on its own: the fit starts with all points counting alike, and the tolerance shrinks
step by step, so that points which move with the face lose their say without a good start.
"""

import numpy as np

from stages.core import rigid_motion

SCALE = 0.015  # face units: a residual that counts a quarter, about a millimetre
WIDEST = 64.0
STEPS = 12


def fit(
    points: np.ndarray, neutral: np.ndarray, origin: int | None = None, scale: float = SCALE
) -> tuple[np.ndarray, np.ndarray]:
    """Fit a rigid motion to every frame.

    Minimises, for each frame, `sum_p r_p^2 / (1 + r_p^2 / (m s^2))` with the residual
    `r_p = |x_p - R n_p - t|`, by reweighting, while `m` falls from 64 to 1.

    Parameters
    ----------
    points : (T, P, 3) float array [face units]; NaN where not observed
    neutral : (P, 3) float array [face units]
    origin : row of the point that is moved to the origin; None takes the weighted centroid
    scale : `s` [face units]

    Returns
    -------
    rotation : (T, 3, 3) float array; NaN where it cannot be told
    translation : (T, 3) float array [face units]
    """
    motion = rigid_motion.fit(points, neutral, np.ones(len(neutral)), origin)
    for wideness in np.geomspace(WIDEST, 1.0, STEPS):
        residuals = rigid_motion.squared_residuals(points, neutral, *motion)
        weights = 1 / (1 + np.nan_to_num(residuals) / (wideness * scale**2)) ** 2
        motion = rigid_motion.fit(points, neutral, weights, origin)
    return motion
