"""What the markers of a face tell of each other: a Gaussian over all their coordinates."""

from typing import NamedTuple

import numpy as np

ROUNDS = 4
RIDGE_ROUNDS = 2  # gaps are filled well enough then to tell how well gaps are filled
FOLDS = 4
RIDGES_MM = (0.03, 0.06, 0.12, 0.25, 0.5, 1.0)
PART = 4096


class Gaussian(NamedTuple):
    """Hold the distribution of a frame's coordinates.

    Attributes
    ----------
    mean : (P, 3) float array [mm]
    covariance : (3P, 3P) float array [mm^2], ridge included
    precision : (3P, 3P) float array, its inverse
    ridge : root of what was added to each variance [mm]
    """

    mean: np.ndarray
    covariance: np.ndarray
    precision: np.ndarray
    ridge: float


def fit(frames: np.ndarray, ridge: float | None = None) -> Gaussian:
    """Fit a Gaussian to frames with gaps by expectation maximisation.

    The ridge `r^2 I` that is added to the covariance is the one that predicts each marker from
    the others best, in blocks of time that the covariance was not made from.

    Parameters
    ----------
    frames : (N, P, 3) float array [mm], NaN where not observed; a marker that is never seen
        stays at the origin and tells nothing
    ridge : r [mm]; None chooses it

    Returns
    -------
    Gaussian
    """
    count, points, _ = frames.shape
    values = frames.reshape(count, -1).astype(float)
    seen = np.isfinite(values)
    mean = np.where(seen, values, 0).sum(axis=0) / np.maximum(seen.sum(axis=0), 1)
    filled = np.where(seen, values, mean)
    unsure = np.zeros((3 * points, 3 * points))
    gaps = not seen.all()
    used = ridge or RIDGES_MM[0]
    for number in range(ROUNDS if gaps else 1):
        if ridge is None and number < RIDGE_ROUNDS:
            used = _best_ridge(filled, seen)
        model = _model(filled, unsure / count, used)
        if gaps:
            filled, unsure = _complete(model, np.where(seen, values, np.nan))
    return model


def complete(model: Gaussian, frames: np.ndarray) -> np.ndarray:
    """Return frames (N, P, 3) with what is missing at its expectation given the rest."""
    filled = frames.copy()
    for first in range(0, len(frames), PART):
        part = frames[first : first + PART]
        if np.isnan(part).any():
            values = part.reshape(len(part), -1).astype(float)
            filled[first : first + PART] = _complete(model, values)[0].reshape(part.shape)
    return filled


def predict_each(model: Gaussian, filled: np.ndarray) -> np.ndarray:
    """Return the expectation of every marker given all the others.

    With the precision Q, `E[x_p | others] = x_p - Q_pp^-1 (Q (x - mean))_p`.

    Parameters
    ----------
    model : the distribution
    filled : (N, P, 3) float array [mm] without gaps

    Returns
    -------
    (N, P, 3) array of the same type
    """
    points = len(model.mean)
    blocks = model.precision.reshape(points, 3, points, 3)
    inverse = np.linalg.inv(blocks[np.arange(points), :, np.arange(points)])
    expected = np.empty_like(filled)
    for first in range(0, len(filled), PART):
        part = filled[first : first + PART] - model.mean
        pull = (part.reshape(len(part), -1) @ model.precision).reshape(part.shape)
        back = np.einsum("pij,npj->npi", inverse, pull)
        expected[first : first + PART] = filled[first : first + PART] - back
    return expected


def predictor(model: Gaussian, marker: int, others: np.ndarray) -> np.ndarray:
    """Return the matrix that predicts a marker's offset from those of others.

    `E[x_p - m_p | x_o] = C_po C_oo^-1 (x_o - m_o)`.

    Parameters
    ----------
    model : the distribution
    marker : its index p
    others : (O,) int array of indices o

    Returns
    -------
    (3, 3 O) float array
    """
    rows = 3 * marker + np.arange(3)
    columns = (3 * others[:, None] + np.arange(3)).ravel()
    known = model.covariance[np.ix_(columns, columns)]
    return np.linalg.solve(known, model.covariance[np.ix_(columns, rows)]).T


def _model(filled: np.ndarray, unsure: np.ndarray, ridge: float) -> Gaussian:
    """Return the Gaussian of complete frames (N, 3P) plus what filling them left open."""
    mean = filled.mean(axis=0)
    offset = filled - mean
    covariance = offset.T @ offset / len(filled) + unsure
    covariance[np.diag_indices_from(covariance)] += ridge**2
    return Gaussian(mean.reshape(-1, 3), covariance, np.linalg.inv(covariance), ridge)


def _best_ridge(filled: np.ndarray, seen: np.ndarray) -> float:
    """Return the ridge [mm] with the smallest mean distance on held-out blocks of time."""
    fold = np.arange(len(filled)) * FOLDS // len(filled)
    error = np.zeros(len(RIDGES_MM))
    for number in range(FOLDS):
        inside, held = filled[fold != number], filled[fold == number]
        if not len(inside) or not len(held):
            continue
        mean = inside.mean(axis=0)
        values, vectors = np.linalg.eigh(np.cov(inside.T, bias=True))
        projected = (held - mean) @ vectors
        for place, ridge in enumerate(RIDGES_MM):
            weights = 1 / (np.maximum(values, 0) + ridge**2)
            pull = (projected * weights) @ vectors.T
            residual = pull / ((vectors**2) @ weights)
            error[place] += np.abs(residual[seen[fold == number]]).sum()
    return RIDGES_MM[int(error.argmin())]


def _complete(model: Gaussian, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return frames (N, 3P) without gaps, and the sum of the covariances of what was missing."""
    mean = model.mean.ravel()
    lost = ~np.isfinite(values)
    offset = np.where(lost, 0, values - mean)
    filled = np.where(lost, mean, values)
    pull = offset @ model.precision
    unsure = np.zeros_like(model.covariance)
    for rows in _alike(lost):
        gaps = np.flatnonzero(lost[rows[0]])
        spread = np.linalg.inv(model.precision[np.ix_(gaps, gaps)])
        filled[np.ix_(rows, gaps)] = mean[gaps] - pull[np.ix_(rows, gaps)] @ spread
        unsure[np.ix_(gaps, gaps)] += len(rows) * spread
    return filled, unsure


def _alike(lost: np.ndarray) -> list[np.ndarray]:
    """Return the rows of a bool array (N, C) in groups that are equal, without those all False."""
    groups: dict[bytes, list[int]] = {}
    bits = np.packbits(lost, axis=1)
    for row in np.flatnonzero(lost.any(axis=1)):
        groups.setdefault(bits[row].tobytes(), []).append(int(row))
    return [np.array(rows) for rows in groups.values()]
