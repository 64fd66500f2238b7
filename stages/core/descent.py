"""Supervised descent: a cascade of ridge regressions from patches round the points to their error.

Eigen-points find the face; this finds each point of it. Every stage looks at the patches round
the present points and predicts where the points should move, one regression a group of points
(mouth, each eye, each brow), so that a mouth never moves with a brow by accident of few labels.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from stages.core import face_frame, patch_features, similarity, warp

SPREADS = (1.0, 1.2, 1.0, 0.8)
SHRINK = 2.0


@dataclasses.dataclass(frozen=True)
class Descent:
    """A trained cascade.

    Attributes
    ----------
    weights : per stage and group (F, 2 Q) float32 array, from descriptors to displacements [px]
    biases : per stage and group (2 Q,) float32 array [px]
    """

    weights: tuple[tuple[np.ndarray, ...], ...]
    biases: tuple[tuple[np.ndarray, ...], ...]


@dataclasses.dataclass(frozen=True)
class Look:
    """What was seen of a face at one pose.

    Attributes
    ----------
    pose : (2, 3) float array, from the face frame to the picture
    channels : (H, W, C) float32 array in the face frame
    """

    pose: np.ndarray
    channels: np.ndarray


def look(
    image: np.ndarray, frame: face_frame.FaceFrame, points: np.ndarray, shrink: float = 1.0
) -> Look:
    """Cut out the face where the points (P, 2) [px] put it, shrunk, and take its gradients."""
    pose = frame.pose(points) * [shrink, shrink, 1]
    size = (round(frame.size[0] / shrink), round(frame.size[1] / shrink))
    return Look(pose, patch_features.gradients(warp.prewarp(image, pose, size)))


def describe(seen: Look, points: np.ndarray) -> np.ndarray:
    """Return the descriptors (P, F) round points (P, 2) [px of the picture], as judged."""
    local = similarity.unapply(seen.pose, points)
    return patch_features.describe(seen.channels, local, SPREADS[-1])


def refine(
    descent: Descent,
    frame: face_frame.FaceFrame,
    groups: Sequence[np.ndarray],
    image: np.ndarray,
    points: np.ndarray,
) -> tuple[np.ndarray, Look]:
    """Move points to where the cascade sees them.

    The face is cut out anew after the first stage only: by then its pose is right. A cascade
    without stages leaves the points as they are.

    Parameters
    ----------
    descent : the cascade
    frame : the face frame that it was trained in
    groups : R int arrays, the points that are moved together
    image : (H, W, 3) uint8 array
    points : (P, 2) float array [px of the picture], the start

    Returns
    -------
    points : (P, 2) float array [px of the picture]
    seen : the last look, in whose frame the last stages worked
    """
    seen = look(image, frame, points, SHRINK if descent.weights else 1.0)
    local = similarity.unapply(seen.pose, points)
    for stage in range(len(descent.weights)):
        if stage == 1:
            seen = look(image, frame, points)
            local = similarity.unapply(seen.pose, points)
        described = patch_features.describe(seen.channels, local, SPREADS[stage])
        for r, group in enumerate(groups):
            step = described[group].reshape(-1) @ descent.weights[stage][r]
            local[group] += (step + descent.biases[stage][r]).reshape(-1, 2)
        points = similarity.apply(seen.pose, local)
    return points, seen


def train(
    images: np.ndarray,
    sources: np.ndarray,
    truth: np.ndarray,
    starts: np.ndarray,
    frame: face_frame.FaceFrame,
    groups: Sequence[np.ndarray],
    ridges: Sequence[float],
) -> tuple[Descent, np.ndarray]:
    """Train the cascade on perturbed starts.

    Each stage minimises `sum_n |x*_n - x_n - W' f_n - b|^2 + r |W|^2` for every group, with `r`
    the stage's ridge times the mean squared length of a descriptor. The next stage starts from
    predictions that leave all pictures of the same face out, which are as wrong as on new film.

    Parameters
    ----------
    images : (N, H, W, 3) uint8 array, the picture of each start
    sources : (N,) int array, the face that each picture shows, ascending
    truth : (N, P, 2) float array [px of the picture]
    starts : (N, P, 2) float array [px of the picture]
    frame : the face frame
    groups : R int arrays that hold each of the P points once
    ridges : strength of each stage, without unit

    Returns
    -------
    descent : the cascade
    reached : (N, P, 2) float array, where the left-out starts end [px of the picture]

    Raises
    ------
    ValueError
        if the shapes disagree
    """
    counts = (len(images), len(sources))
    if truth.shape != starts.shape or counts != (len(starts), len(starts)):
        message = f"{counts} pictures and sources, truth {truth.shape}, starts {starts.shape}"
        raise ValueError(f"starts and their truth do not correspond: {message}")
    blocks = np.split(np.arange(len(sources)), np.flatnonzero(np.diff(sources)) + 1)
    points, weights, biases = starts.copy(), [], []
    for stage, spread in enumerate(SPREADS):
        if stage < 2:
            shrink = SHRINK if stage == 0 else 1.0
            seen = [look(one, frame, x, shrink) for one, x in zip(images, points, strict=True)]
            goal, local = _local(seen, truth), _local(seen, points)
        described = _described(seen, local, spread)
        fitted = [
            _fit(described[:, group], (goal - local)[:, group], blocks, ridges[stage])
            for group in groups
        ]
        for group, (_, _, left_out) in zip(groups, fitted, strict=True):
            local[:, group] += left_out
        weights.append(tuple(fit[0] for fit in fitted))
        biases.append(tuple(fit[1] for fit in fitted))
        points = np.array(
            [similarity.apply(one.pose, x) for one, x in zip(seen, local, strict=True)]
        )
    return Descent(tuple(weights), tuple(biases)), points


def _local(seen: Sequence[Look], points: np.ndarray) -> np.ndarray:
    """Return points (N, P, 2) of pictures [px] as points of what was cut out of them."""
    return np.array([similarity.unapply(one.pose, x) for one, x in zip(seen, points, strict=True)])


def _described(seen: Sequence[Look], local: np.ndarray, spread: float) -> np.ndarray:
    """Return the descriptors (N, P, F) round points (N, P, 2) of what was cut out."""
    pairs = zip(seen, local, strict=True)
    return np.array([patch_features.describe(one.channels, x, spread) for one, x in pairs])


def _fit(
    described: np.ndarray, steps: np.ndarray, blocks: Sequence[np.ndarray], ridge: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve one ridge regression in its dual form; return it and its left-out predictions."""
    rows = described.reshape(len(described), -1)
    targets = steps.reshape(len(steps), -1)
    row_mean, target_mean = rows.mean(axis=0), targets.mean(axis=0)
    rows = rows - row_mean
    gram = (rows @ rows.T).astype(np.float64)
    inverse = np.linalg.inv(gram + ridge * np.trace(gram) / len(gram) * np.eye(len(gram)))
    dual = inverse @ (targets - target_mean)
    weights = rows.T @ dual.astype(np.float32)
    left_out = targets.copy()
    for block in blocks:
        left_out[block] -= np.linalg.solve(inverse[np.ix_(block, block)], dual[block])
    bias = target_mean - row_mean.astype(np.float64) @ weights
    return weights, bias.astype(np.float32), left_out.reshape(steps.shape)
