"""Weights of a rig's shapes from points that correspond to places on it (D06 eq. 7).

``B = B_0 + sum_k w_k B_k``, with B the points of the actor in the character's proportions. The
published solve, `positions`, asks the character to stand where the actor's points are; the others
ask it to move as they do.
"""

from typing import NamedTuple

import numpy as np

from stages.core import clip_least_squares, frame_least_squares

# what a shape of usual length, alone, gives up of its weight: next to nothing, but a hundredth
# where there are more shapes than half of the coordinates, which noise could set at will
RIDGE, WIDE_RIDGE, WIDE = 1e-6, 1e-2, 0.5
# frames with a smaller share of their points are not solved
ENOUGH = 0.5
# at this rate strength 1 counts a second difference of a weight like the same change of its shape
STRENGTH_RATE = 60.0
FRAME_TOLERANCE = 1e-6
# of the strength, for blinks: their peaks stay
BLINK_STRENGTH = 0.02
METHODS = ("positions", "displacements", "bounded", "clip")


class Solution(NamedTuple):
    """Hold the weights of every frame and how far to trust them; NaN where not solved.

    Attributes
    ----------
    weights : (T, K) float array
    residual : (T,) float array [face unit]
        Root mean square of the distances that are left at the observed points.
    kkt_residual : (T,) float array
        Largest change that one weight alone still wants to make.
    """

    weights: np.ndarray
    residual: np.ndarray
    kkt_residual: np.ndarray


def proportions(neutral, places):
    """Return how large the model is against the actor along each axis.

    The ratio of mean distances along the axis between all pairs of points:
    ``sum_ij |places_i - places_j| / sum_ij |neutral_i - neutral_j|``.

    Parameters
    ----------
    neutral : (P, D) float array
        The actor's points at rest.
    places : (P, D) float array
        The places that correspond to them on the model at rest.

    Returns
    -------
    (D,) float array

    Raises
    ------
    ValueError
        When the forms differ, or the points have no extent along an axis.
    """
    if neutral.shape != places.shape or neutral.ndim != 2:
        raise ValueError(f"neutral {neutral.shape} and places {places.shape} do not correspond")
    spread, modelled = (
        np.abs(array[:, None] - array[None]).sum(axis=(0, 1)) for array in (neutral, places)
    )
    if not ((spread > 0) & (modelled > 0)).all():
        raise ValueError(
            f"{len(neutral)} points without extent along each axis give no proportions: use more"
        )
    return modelled / spread


def targets(points, neutral, places, method):
    """Return what the shapes have to add up to, in the character's proportions.

    Parameters
    ----------
    points : (T, P, D) float array [face unit]
    neutral, places : (P, D) float array [face unit]
    method : str
        One of `METHODS`.

    Returns
    -------
    (T, P D) float array [face unit]
        For `positions` the difference to the model at rest, both centred on their points at rest;
        for the others the displacement from the actor's rest.
    """
    scale = proportions(neutral, places)
    if method == "positions":
        centred = (points - neutral.mean(axis=0)) * scale - (places - places.mean(axis=0))
    else:
        centred = (points - neutral) * scale
    return centred.reshape(len(points), -1)


def ridge(matrix):
    """Return the ridge of a matrix (P D, K) whose columns are shapes, as `solve` takes it."""
    coordinates, shapes = matrix.shape
    return _usual(matrix) * (WIDE_RIDGE if shapes > WIDE * coordinates else RIDGE)


def solve(points, neutral, places, deltas, method, lower=0.0, upper=1.0, strength=1.0, rate=60.0):
    """Solve the weights of every frame by one of `METHODS`.

    With a ridge of ``1e-6 |B|^2``, ``|B|^2`` being the mean square length of the shapes, or of
    ``1e-2 |B|^2`` where there are more shapes than half of the coordinates: one answer is left.

    - `positions`, `displacements`: ``|B w_t - x_t|^2`` (least squares);
    - `bounded`: the same subject to ``lower <= w_t <= upper``;
    - `clip`: all frames together, with ``strength_k |B|^2 (rate / 60)^4 (w_t-1 - 2 w_t + w_t+1)^2``
      added for every channel and frame. The fourth power makes the strength one of time: at 1 a
      shape of usual length keeps half of what moves at 10 Hz, at any rate; that frequency goes
      with the strength's power of -1/4.

    All is relative to the size of the shapes: meshes a hundred times as large give the same.

    Parameters
    ----------
    points : (T, P, D) float array [face unit]
        The actor's points; NaN where not observed.
    neutral : (P, D) float array [face unit]
    places : (P, D) float array [character's face unit]
    deltas : (K, P, D) float array [character's face unit]
        What each shape adds to the places.
    method : str
    lower, upper : (K,) float array or float
    strength : (K,) float array or float
        0 for channels that may change at once.
    rate : float [frames per second]

    Returns
    -------
    Solution

    Raises
    ------
    ValueError
        When the forms do not fit, the name is unknown, or no shape moves a point.
    """
    points, deltas = np.asarray(points, float), np.asarray(deltas, float)
    neutral, places = np.asarray(neutral, float), np.asarray(places, float)
    if points.shape[1:] != neutral.shape or deltas.shape[1:] != neutral.shape:
        raise ValueError(
            f"points {points.shape}, shapes {deltas.shape} and neutral {neutral.shape} do not fit"
        )
    if method not in METHODS:
        raise ValueError(f"no solve is called '{method}': choose one of {', '.join(METHODS)}")
    lower, upper, strength = (
        np.broadcast_to(np.asarray(each, float), len(deltas)) for each in (lower, upper, strength)
    )
    matrix = deltas.reshape(len(deltas), -1).T
    seen = np.isfinite(points).all(axis=2)
    enough = seen.mean(axis=1) >= ENOUGH
    wanted = targets(points, neutral, places, method)
    wanted[~np.repeat(seen & enough[:, None], neutral.shape[1], axis=1)] = np.nan
    smooth = strength * _usual(matrix) * (float(rate) / STRENGTH_RATE) ** 4
    weights, kkt_residual = _weights(
        method, matrix, wanted, enough, lower, upper, smooth, float(rate)
    )
    misfit = (weights @ matrix.T - wanted).reshape(points.shape)
    misfit[~np.isfinite(misfit)] = 0.0
    counted = np.maximum(np.sum(seen, axis=1), 1)
    residual = np.sqrt(np.sum(misfit**2, axis=(1, 2)) / counted)
    return Solution(weights, np.where(enough, residual, np.nan), kkt_residual)


def _weights(method, matrix, wanted, enough, lower, upper, smooth, rate):
    """Return the weights (T, K) and KKT residuals (T,) of frames with enough points, NaN else."""
    held = ridge(matrix)
    weights = np.full((len(wanted), matrix.shape[1]), np.nan)
    kkt_residual = np.full(len(wanted), np.nan)
    if method in ("positions", "displacements"):
        weights[enough], kkt_residual[enough] = _unbounded(matrix, wanted[enough], held)
    elif method == "bounded":
        weights[enough], kkt_residual[enough] = frame_least_squares.solve(
            matrix, wanted[enough], lower, upper, held, FRAME_TOLERANCE
        )
    else:
        for run in _runs(enough, rate):
            weights[run], kkt_residual[run] = clip_least_squares.solve(
                matrix, wanted[run], lower, upper, smooth, held
            )
        weights[~enough], kkt_residual[~enough] = np.nan, np.nan
    return weights, kkt_residual


def _usual(matrix):
    """Return the mean square length of the shapes, the columns of a matrix."""
    usual = np.sum(matrix**2) / max(matrix.shape[1], 1)
    if not usual > 0:
        raise ValueError(f"no shape of {matrix.shape[1]} moves any of {len(matrix)} coordinates")
    return usual


def _runs(enough, longest):
    """Yield slices of frames from solved to solved frame, with no longer gap than `longest`."""
    frames = np.flatnonzero(enough)
    cuts = np.flatnonzero(np.diff(frames) > longest)
    for part in np.split(frames, cuts + 1):
        if len(part):
            yield slice(part[0], part[-1] + 1)


def _unbounded(matrix, wanted, ridge):
    """Minimise ``|A w - x|^2 + ridge |w|^2`` on all frames with the same points together."""
    weights = np.zeros((len(wanted), matrix.shape[1]))
    residual = np.zeros(len(wanted))
    seen = np.isfinite(wanted)
    patterns, which = np.unique(seen, axis=0, return_inverse=True)
    for number, pattern in enumerate(patterns):
        rows = np.flatnonzero(which.ravel() == number)
        part, right = matrix[pattern], wanted[rows][:, pattern] @ matrix[pattern]
        gram = part.T @ part + ridge * np.eye(matrix.shape[1])
        weights[rows] = np.linalg.solve(gram, right.T).T
        slope = weights[rows] @ gram - right
        residual[rows] = np.abs(slope / gram.diagonal()).max(axis=1)
    return weights, residual
