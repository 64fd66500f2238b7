"""Write what a frame asks of the layers as a quadratic of displacements and pulls on factors."""

from typing import NamedTuple

import numpy as np

from stages.core import layer_model


class Objective(NamedTuple):
    """Hold ``Q(u) + sum_i pull_i (z_i - target_i)^2 + fixed`` over the solver's point z.

    Attributes
    ----------
    quadratic : the data term, ``1 - g`` included
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
    closeness: float,
    temporal: float,
    before: np.ndarray | None,
) -> Objective:
    """Write a frame's objective with one pull on each weight and coefficient.

    Two pulls on one number are one pull to their mean, and a constant.

    Parameters
    ----------
    model, quadratic : see `layer_model`
    closeness : float in 0..1, of the lips
    temporal : float, at least 0
    before : (R * J + K,) float array, the last frame's point; None on the first frame
    """
    regions, layers, _ = model.sizes
    held = 0.0 if before is None else temporal
    before = np.zeros(len(model.group)) if before is None else before
    closing, closed = np.zeros(len(before)), np.zeros(len(before))
    if closeness > 0.0:
        start = model.lip_mask * layers
        closing[start : start + layers] = closeness
        closed[start + model.speech_layer] = 1.0
        closing[regions * layers :][model.layer == model.speech_layer] = closeness
        closed[regions * layers + model.closed] = 1.0
    pull = closing + held
    target = (closing * closed + held * before) / np.where(pull > 0.0, pull, 1.0)
    fixed = np.sum(closing * closed**2 + held * before**2 - pull * target**2)
    data = 1.0 - closeness
    scaled = layer_model.Quadratic(
        data * quadratic.energy, data * quadratic.linear, data * quadratic.gram, quadratic.span
    )
    return Objective(scaled, pull, target, float(fixed))


def value(model: layer_model.Model, objective: Objective, point: np.ndarray) -> float:
    """Return the objective at a point."""
    u = point[model.first] * point[model.second]
    pulled = np.sum(objective.pull * (point - objective.target) ** 2)
    return float(layer_model.data(objective.quadratic, u) + pulled + objective.fixed)
