"""Solve emotion, speech and blink layers frame by frame, with a proven bound of what is missed.

Kholgade 2011, eq. 7 in finite terms; weights w (R, J) on a simplex under each mask, coefficients a
(K,) on a simplex in each layer, closeness g of the lips, temporal weight l:

    (1 - g) |x - sum_l M_l sum_j w_lj B_j a_j|^2 + g (|w_mouth - e_speech|^2 + |a_speech - e_m|^2)
        + l (|w - w_before|^2 + |a - a_before|^2)
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from stages.core import (
    layer_amplitude,
    layer_kernel,
    layer_model,
    layer_objective,
    layer_relaxation,
    layer_starts,
)

TOLERANCE = 1e-12
CLOSE_ENOUGH = 1e-9
DRAWS = 4
SOFTNESS = 1e-3


class Settings(NamedTuple):
    """Hold the temporal weight at the frames' own rate and how far amplitudes may exceed one."""

    temporal: float = 0.05
    beyond: float = 0.0


class State(NamedTuple):
    """Hold what the next frame needs of the last.

    Attributes
    ----------
    weights : (R, J) float array
    coefficients : (K,) float array
    amplitudes : (J,) float array
    relaxed : (R * K,) float array, where the next relaxation starts
    """

    weights: np.ndarray
    coefficients: np.ndarray
    amplitudes: np.ndarray
    relaxed: np.ndarray


class Solution(NamedTuple):
    """Hold a frame's layers; of a sequence, every attribute has a first axis of T frames.

    Attributes
    ----------
    weights : (R, J) float array
    coefficients : (K,) float array
    amplitudes : (J,) float array
    objective : float, of weights and coefficients, at amplitude one
    bound : float, no weights and coefficients whatever have a lower objective
    data : float, ``|x - sum_l M_l sum_j w_lj s_j B_j a_j|^2``, amplitudes included
    outside : float, root of the data term at amplitude one less that of any linear combination
    """

    weights: np.ndarray
    coefficients: np.ndarray
    amplitudes: np.ndarray
    objective: np.ndarray
    bound: np.ndarray
    data: np.ndarray
    outside: np.ndarray


def temporal_at(rate: float, lambda_at_30: float) -> float:
    """Return the temporal weight that forgets as fast at a rate as the given one at 30 frames/s.

    A pull of weight l on a unit data term keeps ``rho = l / (1 + l)`` of the last frame:
    ``rho_r = rho^(30 / rate)``, ``l_r = rho_r / (1 - rho_r)``.

    Raises
    ------
    ValueError
        if the rate is not positive or the weight is negative
    """
    if not (rate > 0 and lambda_at_30 >= 0 and np.isfinite(rate) and np.isfinite(lambda_at_30)):
        raise ValueError(f"expected a rate > 0 and a weight >= 0, got {rate} and {lambda_at_30}")
    kept = (lambda_at_30 / (1.0 + lambda_at_30)) ** (30.0 / float(rate))
    return float(kept / (1.0 - kept))


def _descend(
    model: layer_model.Model, given: layer_objective.Objective, start: np.ndarray
) -> tuple:
    """Return the objective and the point to which the solver comes from a start."""
    point = start.copy()
    value = layer_kernel.descend(
        given.quadratic.gram,
        model.pairs,
        given.quadratic.linear,
        given.pull,
        given.target,
        model.first,
        model.second,
        model.group,
        point,
        TOLERANCE * model.scale,
        layer_model.RIDGE * model.scale,
    )
    point /= np.bincount(model.group, point)[model.group]
    return value + given.quadratic.energy + given.fixed, point


def _best(
    model: layer_model.Model, given: layer_objective.Objective, previous: State | None
) -> tuple:
    """Return objective, point, bound and relaxed displacements of the best of several starts.

    The last frame's own solution is kept unless another is better by more than rounding, so that
    nothing flickers between equals.
    """
    regions, layers, _ = model.sizes
    enough = CLOSE_ENOUGH * model.scale
    if previous is None:
        starts = layer_starts.draws(model, DRAWS, 0)
        relaxed = np.repeat(1.0 / len(model.layer), len(model.first))
        share = np.full(regions * layers, 1.0 / regions)
        value, point = _descend(model, given, starts[0])
    else:
        starts = []
        relaxed = previous.relaxed
        before = np.concatenate([previous.weights.ravel(), previous.coefficients])
        value, point = _descend(model, given, before)
        heavy = point[: regions * layers].reshape(regions, layers).argmax(axis=0)
        share = (np.arange(regions)[:, None] == heavy).astype(float).ravel()
    relaxed, bound = layer_relaxation.solve(
        model, given.quadratic, given.pull, given.target, share, relaxed
    )
    bound += given.fixed
    if value - bound > enough:
        held = point[regions * layers :]
        alone = layer_starts.singles(model, given.quadratic, given.pull, given.target, held, enough)
        starts += [
            start for start in alone if layer_objective.value(model, given, start) < value - enough
        ]
        for start in [layer_relaxation.factors(model, relaxed, held), *starts]:
            other, place = _descend(model, given, start)
            if other < value - enough:
                value, point = other, place
    return value, point, bound, relaxed


def _amplitudes(model, settings, quadratic, previous, u, closeness) -> np.ndarray:
    """Return the amplitude of each layer, one where the bounds are hard."""
    layers = model.sizes[1]
    if settings.beyond == 0.0:
        return np.ones(layers)
    of_layer = np.tile(model.layer, len(model.masks))
    parts = np.where(of_layer == np.arange(layers)[:, None], u, 0.0)
    data = 1.0 - closeness
    held = 0.0 if previous is None else settings.temporal
    slack = SOFTNESS * model.scale
    before = np.ones(layers) if previous is None else previous.amplitudes
    return layer_amplitude.solve(
        data * (parts @ quadratic.gram @ parts.T),
        data * (parts @ quadratic.linear),
        slack + held,
        (slack + held * before) / (slack + held),
        settings.beyond,
    )


def _nothing(model: layer_model.Model) -> Solution:
    """Return the solution of a frame of which too little was observed."""
    regions, layers, count = model.sizes
    parts = np.full((regions, layers), np.nan), np.full(count, np.nan), np.full(layers, np.nan)
    return Solution(*parts, *(np.nan,) * 4)


def _check(model: layer_model.Model, settings: Settings, closeness: float) -> None:
    """Refuse settings and a closeness that mean nothing."""
    if not (0.0 <= settings.temporal < np.inf and 0.0 <= settings.beyond < np.inf):
        raise ValueError(f"temporal and beyond must be at least 0 and finite, got {settings}")
    if not 0.0 <= closeness <= 1.0:
        raise ValueError(f"closeness must be in 0..1, got {closeness}")
    if closeness > 0.0 and model.lip_mask < 0:
        raise ValueError(f"closeness {closeness} needs a lip mask, which the model has not")


def solve_frame(
    model: layer_model.Model,
    settings: Settings,
    frame: np.ndarray,
    closeness: float = 0.0,
    previous: State | None = None,
) -> tuple[Solution, State | None]:
    """Solve one frame from the last; this is all that a live performance needs.

    Parameters
    ----------
    model : see `layer_model.build`
    settings : see `Settings`
    frame : (D,) float array, less the neutral [balanced]; NaN = not observed
    closeness : float in 0..1, of the lips
    previous : State of the last frame; None = try several starts, nothing is held

    Returns
    -------
    solution : NaN where less than half of the frame was observed
    state : for the next frame; then the previous one

    Raises
    ------
    ValueError
        if arrays do not fit the model or a number is out of range
    """
    _check(model, settings, closeness)
    quadratic = layer_model.project(model, frame)
    if quadratic is None:
        return _nothing(model), previous
    regions, layers, _ = model.sizes
    before, held = None, 0.0
    if previous is not None:
        before = np.concatenate([previous.weights.ravel(), previous.coefficients])
        held = settings.temporal
    given = layer_objective.at(model, quadratic, closeness, held, before)
    value, point, bound, relaxed = _best(model, given, previous)
    weights, coefficients = point[: regions * layers], point[regions * layers :]
    u = point[model.first] * point[model.second]
    hard = quadratic.energy - 2.0 * (quadratic.linear @ u) + u @ quadratic.gram @ u
    amplitudes = _amplitudes(model, settings, quadratic, previous, u, closeness)
    data = hard
    if settings.beyond > 0.0:
        u = u * amplitudes[np.tile(model.layer, regions)]
        data = quadratic.energy - 2.0 * (quadratic.linear @ u) + u @ quadratic.gram @ u
    outside = np.sqrt(max(hard - quadratic.span, 0.0))
    weights = weights.reshape(regions, layers)
    solution = Solution(
        weights, coefficients, amplitudes, value, min(bound, value), max(data, 0.0), outside
    )
    return solution, State(weights, coefficients, amplitudes, relaxed)


def solve(
    model: layer_model.Model,
    settings: Settings,
    frames: Iterable[np.ndarray],
    closeness: Iterable[float],
) -> Solution:
    """Solve a sequence, each frame from the last: `solve_frame` over and over.

    Parameters
    ----------
    model, settings : see `solve_frame`
    frames : (T, D) float array, less the neutral [balanced]; NaN = not observed
    closeness : (T,) float array in 0..1, of the lips

    Returns
    -------
    solution : every attribute with a first axis of T; NaN where less than half was observed

    Raises
    ------
    ValueError
        if arrays do not fit the model or each other
    """
    if np.ndim(frames) != 2 or np.shape(closeness) != np.shape(frames)[:1]:
        raise ValueError(
            f"expected frames (T, D) and closeness (T,), got {np.shape(frames)} and"
            f" {np.shape(closeness)}"
        )
    solutions, state = [], None
    for frame, near in zip(frames, closeness, strict=True):
        solution, state = solve_frame(model, settings, frame, float(near), state)
        solutions.append(solution)
    if not solutions:
        raise ValueError(f"expected at least one frame, got {np.shape(frames)}")
    return Solution(*(np.array(part) for part in zip(*solutions, strict=True)))
