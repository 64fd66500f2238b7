"""Markers in a frame that moves with the head: rigid motion against the take's median face."""

from typing import NamedTuple

import numpy as np

from stages.core import rigid_motion

SAMPLE = 600
ROUNDS = 5
REWEIGHTINGS = 4
STIFF_MM = 0.3
TOLERATED = 3.0
PART = 4096


class Motion(NamedTuple):
    """Hold the head's place on every frame: `x_file = R_t x_face + t_t`.

    Attributes
    ----------
    rotation : (T, 3, 3) float array, NaN on frames with too few markers
    translation : (T, 3) float array [mm]
    """

    rotation: np.ndarray
    translation: np.ndarray


def align(points: np.ndarray) -> Motion:
    """Find the head's motion from all markers, stiff ones first and outliers last.

    Minimises `sum_p w_p rho(|R^T (x_tp - t) - m_p| / s_p)` for each frame, with `m` the median of
    the aligned frames, `s_p` the median distance of marker p from it, or of all markers if that is
    more, `w_p = 1 / s_p^2` and
    Geman and McClure's `rho`, by iteratively reweighted rigid fits.

    Parameters
    ----------
    points : (T, P, 3) float array [mm], NaN where not observed

    Returns
    -------
    Motion

    Raises
    ------
    ValueError
        if no frame holds four markers
    """
    face, spread = _median_face(points)
    rotation = np.empty((len(points), 3, 3))
    translation = np.empty((len(points), 3))
    for first in range(0, len(points), PART):
        part = points[first : first + PART].astype(float)
        fit = _robust_fit(part, face, spread)
        rotation[first : first + PART], translation[first : first + PART] = fit
    return Motion(rotation, translation)


def to_face(points: np.ndarray, motion: Motion) -> np.ndarray:
    """Return points (T, P, 3) in the head's frame, of the same type."""
    return rigid_motion.remove(points, motion.rotation, motion.translation)


def from_face(points: np.ndarray, motion: Motion) -> np.ndarray:
    """Return points (T, P, 3) of the head's frame where they were: the inverse of `to_face`."""
    turned = points @ motion.rotation.astype(points.dtype).transpose(0, 2, 1)
    return turned + motion.translation[:, None].astype(points.dtype)


def _median_face(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the median of aligned frames (P, 3) and each marker's distance from it (P,)."""
    seen = np.isfinite(points[..., 0])
    counts = seen.sum(axis=1)
    least = rigid_motion.MIN_POINTS
    if counts.max(initial=0) < least:
        raise ValueError(f"no frame of {points.shape} holds {least} points: nothing to align")
    usable = np.flatnonzero(counts >= least)
    chosen = usable[np.linspace(0, len(usable) - 1, min(SAMPLE, len(usable))).astype(int)]
    first = chosen[counts[chosen].argmax()]
    sample, face = points[chosen].astype(float), points[first].astype(float)
    face = face - np.nanmean(face, axis=0)
    spread = np.ones(points.shape[1])
    for _ in range(ROUNDS):
        local = to_face(sample, Motion(*_robust_fit(sample, face, spread)))
        known = np.isfinite(local[..., 0]).any(axis=0)
        face = np.full(face.shape, np.nan)
        face[known] = np.nanmedian(local[:, known], axis=0)
        distance = np.linalg.norm(local - face, axis=2)
        moved = np.nanmedian(distance[:, known], axis=0)
        # else the frame would stick to the one marker that it stuck to first
        spread[known] = np.maximum(moved, max(np.median(moved), STIFF_MM))
    return face, spread


def _robust_fit(
    points: np.ndarray, face: np.ndarray, spread: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return rotations and translations that bring a face (P, 3) to frames (T, P, 3)."""
    known = np.isfinite(face[:, 0])
    onto = np.where(known[:, None], face, 0)
    start = known / spread**2
    motion = rigid_motion.fit(points, onto, start)
    for _ in range(REWEIGHTINGS - 1):
        squares = np.nan_to_num(rigid_motion.squared_residuals(points, onto, *motion))
        weights = start / (1 + squares / (TOLERATED * spread) ** 2) ** 2
        motion = rigid_motion.fit(points, onto, weights)
    return motion
