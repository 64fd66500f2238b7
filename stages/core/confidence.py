"""How far to trust each tracked point: how much its surroundings look like the labelled ones.

The patches round the points of labelled faces and their morphs span a subspace for every point.
On a new frame each point's distance from its own subspace, that of its neighbours and that of the
whole face are compared with faces that were left out (right) and with points moved off, covered or
put on the background (wrong); a logistic regression turns them into a probability.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

COMPONENTS = 12
RIDGE = 1e-2
ROUNDS = 30


@dataclasses.dataclass(frozen=True)
class Judge:
    """A trained judge of patches.

    Attributes
    ----------
    mean : (P, F) float32 array
    basis : (P, F, C) float32 array, orthonormal columns
    usual : (P,) float array, the usual log distance of a right point
    weights : (4,) float array: constant, own, group's and face's excess of log distance
    """

    mean: np.ndarray
    basis: np.ndarray
    usual: np.ndarray
    weights: np.ndarray


def span(described: np.ndarray, components: int = COMPONENTS) -> tuple[np.ndarray, np.ndarray]:
    """Return mean (P, F) and principal directions (P, F, C) of descriptors (N, P, F)."""
    mean = described.mean(axis=0)
    centred = (described - mean).transpose(1, 0, 2)
    count = min(components, len(described) - 1)
    gram = centred @ centred.transpose(0, 2, 1)
    sizes, vectors = np.linalg.eigh(gram.astype(np.float64))
    sizes, vectors = sizes[:, ::-1][:, :count], vectors[:, :, ::-1][:, :, :count]
    scaled = vectors / np.sqrt(np.maximum(sizes, 1e-12))[:, None]
    return mean, (centred.transpose(0, 2, 1) @ scaled.astype(np.float32)).astype(np.float32)


def log_distance(mean: np.ndarray, basis: np.ndarray, described: np.ndarray) -> np.ndarray:
    """Return the log distance of each point's descriptor from its subspace, (P,) float64.

    Parameters
    ----------
    mean : (P, F) float32 array
    basis : (P, F, C) float32 array
    described : (P, F) float32 array
    """
    centred = described - mean
    inside = np.matmul(centred[:, None], basis)[:, 0]
    square = (centred**2).sum(axis=1) - (inside**2).sum(axis=1)
    return 0.5 * np.log(np.maximum(square, 0) + 1e-6).astype(np.float64)


def train(
    mean: np.ndarray,
    basis: np.ndarray,
    right: np.ndarray,
    wrong: np.ndarray,
    is_wrong: np.ndarray,
    groups: Sequence[np.ndarray],
) -> Judge:
    """Fit the probability that a point is right.

    Minimises the logistic loss over all points of all faces with right and wrong weighing alike,
    plus a small ridge.

    Parameters
    ----------
    mean, basis : the subspaces
    right : (N, P) float array, log distances of labelled points that were left out
    wrong : (M, P) float array, log distances of faces of which some points are wrong
    is_wrong : (M, P) bool array, which ones
    groups : R int arrays, points that belong together
    """
    usual = np.median(right, axis=0)
    faces = np.concatenate([right, wrong]) - usual
    bad = np.concatenate([np.zeros(right.shape, bool), is_wrong]).ravel()
    rows = np.concatenate([_rows(face, groups) for face in faces])
    share = np.where(bad, 0.5 / bad.sum(), 0.5 / (~bad).sum())
    weights = np.zeros(4)
    for _ in range(ROUNDS):
        chance = _logistic(rows @ weights)
        gradient = rows.T @ (share * (chance - ~bad)) + RIDGE * weights * [0, 1, 1, 1] / 4
        curvature = (rows * (share * (chance * (1 - chance) + 1e-9))[:, None]).T @ rows
        weights = weights - np.linalg.solve(curvature + RIDGE * np.eye(4) / 4, gradient)
    return Judge(mean, basis, usual, weights)


def judge(
    model: Judge, described: np.ndarray, groups: Sequence[np.ndarray]
) -> tuple[np.ndarray, float]:
    """Return the confidence of each point, (P,), and of the face, from descriptors (P, F)."""
    excess = log_distance(model.mean, model.basis, described) - model.usual
    points = _logistic(_rows(excess, groups) @ model.weights)
    return points, float(np.median(points))


def _rows(excess: np.ndarray, groups: Sequence[np.ndarray]) -> np.ndarray:
    """Return constant, own, group's and face's excess for every point, (P, 4)."""
    shared = np.empty_like(excess)
    for group in groups:
        shared[group] = excess[group].mean()
    face = np.full_like(excess, np.median(excess))
    return np.stack([np.ones_like(excess), excess, shared, face], axis=1)


def _logistic(values: np.ndarray) -> np.ndarray:
    """Return 1 / (1 + exp(-v))."""
    return 1 / (1 + np.exp(-np.clip(values, -40, 40)))
