"""Ridge regression of many targets on one design, each with its own lambda (D06 equations 5, 6).

One singular value decomposition of the design serves every target and every lambda.
"""

from typing import NamedTuple

import numpy as np

# lambdas tried, as shares of the largest squared singular value of the design
LOWEST, HIGHEST, PER_DECADE = -12, 2, 4
ITERATIONS, TOLERANCE = 1000, 1e-12


class Design(NamedTuple):
    """Hold a design whose columns pay for their weights, beside free columns that do not.

    Attributes
    ----------
    free : (N, Q) float array
    design : (N, M) float array
    basis : (N, Q) float array
        Orthonormal columns that span the free ones.
    left, singular, right : (N, R), (R,), (R, M) float arrays
        What is left of the design off that span, decomposed.
    """

    free: np.ndarray
    design: np.ndarray
    basis: np.ndarray
    left: np.ndarray
    singular: np.ndarray
    right: np.ndarray


def decompose(design, free=None):
    """Decompose a design for all that follows.

    Parameters
    ----------
    design : (N, M) float array
    free : (N, Q) float array, optional
        Columns whose weights cost nothing, as a constant.

    Returns
    -------
    Design

    Raises
    ------
    ValueError
        When there are not more rows than free columns, or the two differ in rows.
    """
    design = np.asarray(design, float)
    free = np.zeros((len(design), 0)) if free is None else np.asarray(free, float)
    if len(free) != len(design) or free.shape[1] >= len(design):
        message = f"a design of shape {design.shape} with free columns of shape {free.shape}"
        raise ValueError(f"{message}: needs as many rows, and more rows than free columns")
    basis = np.linalg.qr(free)[0]
    rest = design - basis @ (basis.T @ design)
    return Design(free, design, basis, *np.linalg.svd(rest, full_matrices=False))


def decompose_kernel(kernel, free=None):
    """Decompose the design of a kernel, whose products of rows are the kernel's entries.

    With ``w`` of `solve`, ``dual(parts, w)`` are the weights of the kernel's columns.

    Parameters
    ----------
    kernel : (N, N) float array
        Symmetric, no eigenvalue below zero.
    free : (N, Q) float array, optional

    Returns
    -------
    Design
    """
    kernel = np.asarray(kernel, float)
    free = np.zeros((len(kernel), 0)) if free is None else np.asarray(free, float)
    whole = np.linalg.qr(free, mode="complete")[0]
    # in coordinates off the free columns, so that no small direction leans on them
    basis, off = whole[:, : free.shape[1]], whole[:, free.shape[1] :]
    energy, turned = np.linalg.eigh(off.T @ kernel @ off)
    kept = energy > energy.max(initial=0.0) * len(kernel) * np.finfo(float).eps
    left, singular = off @ turned[:, kept], np.sqrt(energy[kept])
    return Design(free, left * singular, basis, left, singular, np.eye(len(singular)))


def dual(parts, weights):
    """Return the weights (N, K) of a kernel's columns that equal weights (M, K) of its design."""
    return parts.left @ (weights / parts.singular[:, None])


def choose(parts, targets):
    """Find for each target the lambda that minimises ``N |P y|^2 / (tr P)^2``.

    ``P = I - H (H'H + lambda I)^-1 H'``. It has several minima: each of a grid is the start of the
    published re-estimation, ``lambda <- y'P^2 y tr(A^-1 - lambda A^-2) / (w'A^-1 w tr P)``, which
    is repeated until the criterion stays; the lowest is taken.

    Parameters
    ----------
    parts : Design
    targets : (N, K) float array

    Returns
    -------
    (K,) float array
        The highest of the grid for a target that the free columns explain.

    Notes
    -----
    D06 section 6; Orr 1996 for the formula.
    """
    rotated, outside = _rotate(parts, targets)
    energy = parts.singular**2
    largest = energy.max(initial=0.0) or 1.0
    grid = largest * np.logspace(LOWEST, HIGHEST, (HIGHEST - LOWEST) * PER_DECADE + 1)
    scores = np.stack([_score(parts, rotated, outside, value) for value in grid])
    padded = np.pad(scores, ((1, 1), (0, 0)), constant_values=np.inf)
    # the last of equals: what cannot be told apart is smoothed most
    minima = (scores <= padded[:-2]) & (scores < padded[2:])
    best, lowest = grid[-1 - scores[::-1].argmin(axis=0)], scores.min(axis=0)
    for row in np.flatnonzero(minima.any(axis=1)):
        held = np.flatnonzero(minima[row])
        found, reached = _reestimated(parts, rotated[:, held], outside[held], grid, grid[row])
        better = reached < lowest[held]
        best[held[better]], lowest[held[better]] = found[better], reached[better]
    return best


def _reestimated(parts, rotated, outside, grid, start):
    """Return the lambdas (K,) that re-estimation meets from one start, and their criterion."""
    best = np.full(len(outside), start)
    lowest = _score(parts, rotated, outside, best)
    current, open_ = best.copy(), np.arange(len(best))
    for _ in range(ITERATIONS):
        part = rotated[:, open_], outside[open_]
        current = np.clip(_estimate(parts, *part, current), grid[0], grid[-1])
        reached, before = _score(parts, *part, current), lowest[open_]
        better = reached < before
        best[open_[better]], lowest[open_[better]] = current[better], reached[better]
        moving = np.abs(reached - before) > TOLERANCE * before
        open_, current = open_[moving], current[moving]
        if len(open_) == 0:
            break
    return best, lowest


def score(parts, targets, lambdas):
    """Return the criterion (K,) that `choose` minimises, at one lambda a target."""
    return _score(parts, *_rotate(parts, targets), np.asarray(lambdas, float))


def solve(parts, targets, lambdas):
    """Minimise ``|y - F b - H w|^2 + lambda |w|^2`` for every target (D06 equation 6).

    Parameters
    ----------
    parts : Design
    targets : (N, K) float array
    lambdas : (K,) float array, positive

    Returns
    -------
    b : (Q, K) float array
    w : (M, K) float array
    """
    rotated, _ = _rotate(parts, targets)
    shrunk = parts.singular[:, None] / (parts.singular[:, None] ** 2 + lambdas) * rotated
    weights = parts.right.T @ shrunk
    rest = np.asarray(targets, float) - parts.design @ weights
    return np.linalg.lstsq(parts.free, rest, rcond=None)[0], weights


def leave_one_out(parts, targets, lambdas):
    """Return target minus prediction for every row, predicted from all the others.

    ``(P y)_i / P_ii``; the columns of the design and the lambdas stay as they are.

    Parameters
    ----------
    parts : Design
    targets : (N, K) float array
    lambdas : (K,) float array, positive

    Returns
    -------
    (N, K) float array
    """
    rotated, _ = _rotate(parts, targets)
    kept = 1.0 - _lost(parts, lambdas)
    residual = np.asarray(targets, float) - parts.basis @ (parts.basis.T @ targets)
    residual = residual - parts.left @ (kept * rotated)
    own = 1.0 - np.sum(parts.basis**2, axis=1)[:, None] - parts.left**2 @ kept
    return residual / np.maximum(own, np.finfo(float).eps)


def _rotate(parts, targets):
    """Return targets along the left vectors (R, K), and their squared length off them (K,)."""
    targets = np.asarray(targets, float)
    targets = targets - parts.basis @ (parts.basis.T @ targets)
    rotated = parts.left.T @ targets
    outside = np.sum((targets - parts.left @ rotated) ** 2, axis=0)
    return rotated, outside


def _lost(parts, lambdas):
    """Return the share of each direction that a fit gives up, (R, K) or (R, 1)."""
    return lambdas / (parts.singular[:, None] ** 2 + lambdas)


def _freedom(parts, lost):
    """Return ``tr P``, free of cancellation where lambda is small."""
    rows, directions = parts.left.shape
    return rows - parts.basis.shape[1] - directions + lost.sum(axis=0)


def _score(parts, rotated, outside, lambdas):
    """Return the criterion for targets that are rotated already."""
    lost = _lost(parts, lambdas)
    squares = np.sum((lost * rotated) ** 2, axis=0) + outside
    return len(parts.left) * squares / _freedom(parts, lost) ** 2


def _estimate(parts, rotated, outside, lambdas):
    """Return the next lambdas of the re-estimation; the same where it is not defined."""
    lost, energy = _lost(parts, lambdas), parts.singular[:, None] ** 2
    squares = np.sum((lost * rotated) ** 2, axis=0) + outside
    slope = np.sum(energy / (energy + lambdas) ** 2, axis=0)
    size = np.sum(energy * rotated**2 / (energy + lambdas) ** 3, axis=0) * _freedom(parts, lost)
    return np.where(size > 0, squares * slope / np.where(size > 0, size, 1.0), lambdas)
