"""Solve emotion, speech and blink layers frame by frame, with a proven bound of what is missed.

Kholgade 2011, eq. 7 in finite terms; weights w (R, J) on a simplex under each mask, coefficients a
(K,) on a simplex in each layer, closeness g of the lips, temporal weight l:

    (1 - g) |x - sum_l M_l sum_j w_lj B_j a_j|^2 + g (|w_mouth - e_speech|^2 + |a_speech - e_m|^2)
        + l (|w - w_before|^2 + |a - a_before|^2)
"""

from typing import NamedTuple

import numpy as np

from stages.core import layer_amplitude, layer_gap, layer_model, layer_objective, layer_search

SOFTNESS = 1e-3
LIP_BIASES = ("gap", "mouth", "published")


class Settings(NamedTuple):
    """Hold how layers are solved.

    Attributes
    ----------
    temporal : weight of the last frame, at the frames' own rate
    beyond : how far the amplitude of each mask may exceed one, see `layer_amplitude`
    lean : pull of the weights towards the layers that move what is under each mask
    lip_bias : what closeness g of the lips does. `published`: as above. `mouth`: ``1 - g`` stands
        only before what lies under the lips' mask, so that closed lips do not hold the rest of the
        face still. `gap`: nothing gives way and nothing is drawn to /m/, but the character's gap
        is one more row of data, see `layer_gap`
    """

    temporal: float = 0.05
    beyond: float = 0.0
    lip_bias: str = "published"
    lean: float = 0.0


class State(NamedTuple):
    """Hold what the next frame needs of the last.

    Attributes
    ----------
    weights : (R, J) float array
    coefficients : (K,) float array
    amplitudes : (R,) float array
    guide : where the next frame's convex problems start; None = anywhere
    """

    weights: np.ndarray
    coefficients: np.ndarray
    amplitudes: np.ndarray
    guide: layer_search.Guide | None = None


class Solution(NamedTuple):
    """Hold a frame's layers; of a sequence, every attribute has a first axis of T frames.

    Attributes
    ----------
    weights : (R, J) float array
    coefficients : (K,) float array
    amplitudes : (R,) float array, of the masks, 1 to 1 + beyond
    objective : float, of the best weights and coefficients that were found at amplitude one
    bound : float, no weights and coefficients whatever have a lower one
    data : float, ``|x - sum_l M_l s_l sum_j w_lj B_j a_j|^2``, amplitudes included
    outside : float, root of what the data term, at amplitude one, has above that of the best
        linear combination under each mask
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


def _amplified(
    model: layer_model.Model,
    settings: Settings,
    objective: layer_objective.Objective,
    point: np.ndarray,
    previous: State | None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the solver's point and the amplitude of each mask, one where bounds are hard."""
    if settings.beyond == 0.0:
        return point, np.ones(len(model.masks))
    if previous is not None and settings.temporal > 0.0:
        # what is held of the last frame is what it showed, amplitudes included
        more = settings.temporal * previous.weights * (previous.amplitudes - 1.0)[:, None]
        target = objective.target.copy()
        target[: more.size] += more.ravel() / objective.pull[: more.size]
        objective = objective._replace(target=target)
    ridge = SOFTNESS * model.scale
    return layer_amplitude.follow(model, objective, point, ridge, settings.beyond)


def check(model: layer_model.Model, settings: Settings, frames, closeness) -> None:
    """Refuse sequences that do not fit the model and numbers that mean nothing."""
    if np.shape(frames)[1:] != model.basis.shape[:1] or np.shape(closeness) != (len(frames),):
        raise ValueError(
            f"expected frames (T, {len(model.basis)}) and closeness (T,), got {np.shape(frames)}"
            f" and {np.shape(closeness)}"
        )
    if not len(frames):
        raise ValueError(f"expected at least one frame, got {np.shape(frames)}")
    if not (0.0 <= settings.temporal < np.inf and 0.0 <= settings.beyond < np.inf):
        raise ValueError(f"temporal and beyond must be at least 0 and finite, got {settings}")
    if settings.lip_bias not in LIP_BIASES:
        raise ValueError(f"lip_bias must be one of {LIP_BIASES}, got {settings.lip_bias}")
    near = np.asarray(closeness)
    if not ((near >= 0.0) & (near <= 1.0)).all():
        raise ValueError(f"closeness must be in 0..1, got {near.min()} to {near.max()}")
    if not len(model.lips) and near.any():
        raise ValueError(f"closeness of {near.max()} needs a lip mask, which the model has not")


def stated(
    model: layer_model.Model,
    settings: Settings,
    frame: np.ndarray,
    quadratic: layer_model.Quadratic,
    closeness: float,
    before: np.ndarray | None,
) -> layer_objective.Objective:
    """Return a frame's objective, given its data term and the last frame's point, if any."""
    yielding = quadratic
    if closeness > 0.0 and settings.lip_bias == "gap":
        yielding = quadratic = layer_gap.closing(model, quadratic, closeness)
        closeness = 0.0
    elif closeness > 0.0 and settings.lip_bias == "mouth":
        yielding = layer_model.under_lips(model, frame)
    found = layer_objective.at(model, quadratic, yielding, closeness, settings.temporal, before)
    return layer_objective.leaning(model, found, settings.lean) if settings.lean else found


def describe(
    model: layer_model.Model,
    quadratic: layer_model.Quadratic,
    point: np.ndarray,
    amplitudes: np.ndarray,
    objective: float,
    bound: float,
    outside: float,
) -> Solution:
    """Return a frame's solution, given the solver's point."""
    regions, layers, _ = model.sizes
    weights = point[: regions * layers].reshape(regions, layers)
    u = (weights * amplitudes[:, None]).ravel()[model.first] * point[model.second]
    data = layer_model.data(quadratic, u)
    return Solution(
        weights,
        point[regions * layers :],
        amplitudes,
        objective,
        min(bound, objective),
        max(data, 0.0),
        outside,
    )


def nothing(model: layer_model.Model) -> Solution:
    """Return the solution of a frame of which too little was observed."""
    regions, layers, count = model.sizes
    parts = np.full((regions, layers), np.nan), np.full(count, np.nan), np.full(regions, np.nan)
    return Solution(*parts, *(np.nan,) * 4)


def stacked(solutions: list[Solution]) -> Solution:
    """Return frames' solutions as one of arrays over the frames."""
    return Solution(*(np.array(part) for part in zip(*solutions, strict=True)))


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
    check(model, settings, np.asarray(frame)[None], np.array([closeness]))
    quadratic = layer_model.project(model, frame)
    if quadratic is None:
        return nothing(model), previous
    before = guide = None
    if previous is not None:
        before = np.concatenate([previous.weights.ravel(), previous.coefficients])
        guide = previous.guide
    objective = stated(model, settings, frame, quadratic, closeness, before)
    found = layer_search.best(model, objective, before, guide)
    outside = layer_model.outside(model, quadratic, found.point)
    point, amplitudes = _amplified(model, settings, objective, found.point, previous)
    solution = describe(model, quadratic, point, amplitudes, found.value, found.bound, outside)
    state = State(solution.weights, solution.coefficients, amplitudes, found.guide)
    return solution, state


def solve(
    model: layer_model.Model,
    settings: Settings,
    frames: np.ndarray,
    closeness: np.ndarray,
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
        if arrays do not fit the model or each other, or a number is out of range
    """
    check(model, settings, frames, closeness)
    solutions, state = [], None
    for frame, near in zip(frames, closeness, strict=True):
        solution, state = solve_frame(model, settings, frame, float(near), state)
        solutions.append(solution)
    return stacked(solutions)
