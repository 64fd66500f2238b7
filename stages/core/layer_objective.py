"""Write what a frame asks of the layers as a quadratic of displacements and pulls on factors."""

from typing import NamedTuple

import numba
import numpy as np

from stages.core import layer_model


class Objective(NamedTuple):
    """Hold ``Q(u) + sum_i pull_i (z_i - target_i)^2 + fixed`` over the solver's point z.

    Attributes
    ----------
    quadratic : the data term, less what gives way to closed lips
    pull, target : (R * J + K,) float array
    fixed : float
    """

    quadratic: layer_model.Quadratic
    pull: np.ndarray
    target: np.ndarray
    fixed: float


def at(
    model: layer_model.Model,
    quadratic: layer_model.Quadratic,
    yielding: layer_model.Quadratic,
    closeness: float,
    temporal: float,
    before: np.ndarray | None,
) -> Objective:
    """Write a frame's objective with one pull on each weight and coefficient.

    Two pulls on one number are one pull to their mean, and a constant.

    Parameters
    ----------
    model, quadratic : see `layer_model`
    yielding : the part of the data term that gives way to closed lips: all of it, or the mouth's
    closeness : float in 0..1, of the lips
    temporal : float, at least 0
    before : (R * J + K,) float array, the last frame's point; None on the first frame
    """
    held = 0.0 if before is None else temporal
    target = np.zeros(len(model.group)) if before is None else before.copy()
    pull, fixed = np.full(len(model.group), float(held)), 0.0
    if closeness > 0.0:
        old, aim = target[model.lips], model.closed_lips
        pull[model.lips] += closeness
        mean = (held * old + closeness * aim) / (held + closeness)
        fixed = float(np.sum(held * (old - mean) ** 2 + closeness * (aim - mean) ** 2))
        target[model.lips] = mean
        quadratic = layer_model.Quadratic(
            quadratic.energy - closeness * yielding.energy,
            quadratic.linear - closeness * yielding.linear,
            quadratic.gram - closeness * yielding.gram,
            quadratic.span,
        )
    return Objective(quadratic, pull, target, fixed)


def leaning(model: layer_model.Model, objective: Objective, lean: float) -> Objective:
    """Add a slight pull of the weights towards the layers that move what is under each mask.

    ``lean |w_l - s_l|^2`` with ``s_lj`` the share of layer j in the mean squared extremes under
    mask l. It decides where the data term cannot: all layers share the neutral, so that a layer
    which moves nothing there, as speech does at the eyes, could hold the others back at no cost.

    Parameters
    ----------
    model, objective : see above
    lean : float, at least 0
    """
    weights = slice(0, len(model.shares))
    old, target, pull = objective.target[weights], objective.target.copy(), objective.pull.copy()
    held = pull[weights].copy()
    pull[weights] += lean
    mean = (held * old + lean * model.shares) / pull[weights]
    target[weights] = mean
    apart = np.sum(held * (old - mean) ** 2 + lean * (model.shares - mean) ** 2)
    return Objective(objective.quadratic, pull, target, objective.fixed + float(apart))


def value(model: layer_model.Model, objective: Objective, point: np.ndarray) -> float:
    """Return the objective at a point."""
    quadratic, pull, target, fixed = objective
    varying = _varying(
        quadratic.gram, quadratic.linear, pull, target, model.first, model.second, point
    )
    return varying + quadratic.energy + fixed


@numba.njit(cache=True)
def _varying(gram, linear, pull, target, first, second, point):
    """Return the objective less what does not depend on the point."""
    total = 0.0
    for i in range(len(first)):
        moved = point[first[i]] * point[second[i]]
        if moved != 0.0:
            curved = -2.0 * linear[i]
            for j in range(len(first)):
                curved += gram[i, j] * point[first[j]] * point[second[j]]
            total += curved * moved
    for i in range(len(point)):
        total += pull[i] * (point[i] - target[i]) ** 2
    return total
