"""Weights of key shapes for every frame, by named solves (CB02 section 4.1)."""

from typing import NamedTuple

import numpy as np

from stages.core import box_least_squares, simplex_least_squares

# how far weights of tolerant_even may leave 0..1 where the settings do not say
EVEN_BOUND = 0.2
# length of the error that all sculpts share, against the one of each
_SHARED = 0.25


class Solution(NamedTuple):
    """Hold the weights of every frame and how far to trust them.

    Attributes
    ----------
    weights : (T, K) float array
    residual : (T,) float array [feature unit]
        Distance of the frame from ``neutral + sum_i w_i (shape_i - neutral)``, the point
        that the contract of the bake gives these weights.
    kkt_residual : (T,) float array
        Largest change that one weight still wants to make on its own; 0 at the exact answer.
    """

    weights: np.ndarray
    residual: np.ndarray
    kkt_residual: np.ndarray


def nonnegative_absolute(frames, shapes, neutral, sigma, bound):
    """Minimise ``|x - sum_i w_i s_i|^2`` over ``w >= 0``, shapes as they are (CB02 eq. 4)."""
    del neutral, sigma
    return _boxed(frames, shapes, _nothing(shapes), 0.0, bound)


def nonnegative_offset(frames, shapes, neutral, sigma, bound):
    """Minimise ``|x - n - sum_i w_i d_i|^2`` over ``w >= 0``, with ``d_i = s_i - n``."""
    del sigma
    return _boxed(frames - neutral, shapes - neutral, _nothing(shapes), 0.0, bound)


def least_squares(frames, shapes, neutral, sigma, bound):
    """Minimise ``|x - n - sum_i w_i d_i|^2``, with ``d_i = s_i - n``."""
    del sigma
    return _boxed(frames - neutral, shapes - neutral, _nothing(shapes), -np.inf, bound)


def tolerant(frames, shapes, neutral, sigma, bound):
    """Minimise ``|x - n - sum_i w_i d_i|^2 + sigma^2 sum_i w_i^2 |d_i|^2``.

    This is the error expected in the target when every sculpt is off by `sigma` times its own
    distance from the neutral, independently of the others.
    """
    offsets = shapes - neutral
    penalty = np.diag(sigma * np.linalg.norm(offsets, axis=1))
    return _boxed(frames - neutral, offsets, penalty, -np.inf, bound)


def tolerant_even(frames, shapes, neutral, sigma, bound):
    """Minimise ``|x - n - sum_i w_i d_i|^2 + sum_i w_i^2 e_i^2 + b^2 (sum_i w_i)^2``.

    `even_errors` gives e_i and b: an artist, and the tracking of the key shape itself, are off
    by an amount that shrinks less than the pose does, and all sculpts share some of it.
    """
    offsets = shapes - neutral
    own, shared = even_errors(np.sum(offsets**2, axis=1), sigma)
    penalty = np.vstack([np.diag(np.sqrt(own)), np.full((1, len(shapes)), np.sqrt(shared))])
    bound = EVEN_BOUND if bound is None else bound
    return _boxed(frames - neutral, offsets, penalty, -np.inf, bound)


def even_errors(squares, sigma):
    """Return the squared error expected of every sculpt (K,), and that which all share.

    ``e_i^2 = sigma^2 (|d_i|^2 + m^2) / 2`` and ``b^2 = (sigma / 4)^2 m^2``, m being the root mean
    square of the lengths ``|d_i|``.

    Parameters
    ----------
    squares : (K,) float array [feature unit squared]
        ``|d_i|^2``.
    sigma : float
    """
    mean = np.mean(squares) if len(squares) else 0.0
    return sigma**2 * (squares + mean) / 2, (_SHARED * sigma) ** 2 * mean


def simplex(frames, shapes, neutral, sigma, bound):
    """Minimise ``|x - w_0 n - sum_i w_i s_i|^2`` over ``w >= 0`` with ``w_0 + sum_i w_i = 1``."""
    del sigma, bound
    corners = np.vstack([neutral, shapes])
    weights, kkt_residual = simplex_least_squares.solve(corners, frames)
    return weights[:, 1:], kkt_residual


SOLVES = {
    "nonnegative_absolute": nonnegative_absolute,
    "nonnegative_offset": nonnegative_offset,
    "simplex": simplex,
    "least_squares": least_squares,
    "tolerant": tolerant,
    "tolerant_even": tolerant_even,
}


def solve(frames, shapes, neutral, method, sigma=0.0, bound=None):
    """Solve the weights of every frame by one of `SOLVES`.

    Parameters
    ----------
    frames : (T, D) float array [feature unit]
    shapes : (K, D) float array [feature unit]
    neutral : (D,) float array [feature unit]
    method : str
        A name in `SOLVES`.
    sigma : float
        Error expected of a sculpt as a share of its distance from the neutral; both
        tolerant solves.
    bound : float or None
        Keep weights within ``[-bound, 1 + bound]``, non-negative solves within
        ``[0, 1 + bound]``; None for no bound, and for 0.2 with `tolerant_even`. A simplex is
        bounded by itself.

    Returns
    -------
    Solution

    Raises
    ------
    ValueError
        When the shapes do not fit, a value is not finite, or the name is unknown.
    """
    frames, shapes = np.asarray(frames, float), np.asarray(shapes, float)
    neutral = np.asarray(neutral, float)
    if frames.ndim != 2 or shapes.shape[1:] != neutral.shape or frames.shape[1:] != neutral.shape:
        raise ValueError(
            f"frames {frames.shape}, shapes {shapes.shape}, neutral {neutral.shape} do not fit"
        )
    if not all(np.isfinite(array).all() for array in (frames, shapes, neutral)):
        raise ValueError(f"frames {frames.shape} or shapes {shapes.shape} hold NaN or infinity")
    if method not in SOLVES:
        raise ValueError(f"no solve is called '{method}': choose one of {', '.join(SOLVES)}")
    weights, kkt_residual = SOLVES[method](frames, shapes, neutral, sigma, bound)
    residual = np.linalg.norm(frames - neutral - weights @ (shapes - neutral), axis=1)
    return Solution(weights, residual, kkt_residual)


def _nothing(shapes):
    """Return the penalty (0, K) of a solve that tolerates nothing."""
    return np.zeros((0, len(shapes)))


def _boxed(targets, columns, penalty, least, bound):
    """Minimise ``|x - sum_i w_i c_i|^2 + |penalty w|^2`` above `least` and within `bound`."""
    low, high = (least, np.inf) if bound is None else (max(least, -bound), 1 + bound)
    lower, upper = np.full(len(columns), low), np.full(len(columns), high)
    matrix = np.vstack([columns.T, penalty])
    padded = np.hstack([targets, np.zeros((len(targets), len(penalty)))])
    weights = box_least_squares.solve(matrix, padded, lower, upper)
    return weights, box_least_squares.kkt_residual(matrix, padded, lower, upper, weights)
