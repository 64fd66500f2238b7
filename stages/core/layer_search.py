"""Look for the layers of one frame from several starts, and say how much could be better."""

from typing import NamedTuple

import numpy as np

from stages.core import (
    layer_kernel,
    layer_model,
    layer_objective,
    layer_relaxation,
    layer_starts,
)

TOLERANCE = 1e-12
CLOSE_ENOUGH = 1e-9
DRAWS = 4


class Guide(NamedTuple):
    """Hold where a search's convex problems ended, from where the next frame's may start.

    Attributes
    ----------
    relaxed : (R * K,) float array, displacements of the relaxation
    alone : (K,) float array, coefficients of each layer on its own
    """

    relaxed: np.ndarray
    alone: np.ndarray


class Found(NamedTuple):
    """Hold what a search came to.

    Attributes
    ----------
    value : float, the objective
    point : (R * J + K,) float array
    bound : float, no point has a lower objective
    guide : what the next search may start from
    """

    value: float
    point: np.ndarray
    bound: float
    guide: Guide


def descend(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    start: np.ndarray,
    sums: np.ndarray | float = 1.0,
) -> tuple[float, np.ndarray]:
    """Return the objective and the point to which feasible SQP comes from a start.

    The start has the sums (by group) that the point is to keep.
    """
    point = start.copy()
    value = layer_kernel.descend(
        objective.quadratic.gram,
        model.pairs,
        objective.quadratic.linear,
        objective.pull,
        objective.target,
        model.first,
        model.second,
        model.group,
        point,
        TOLERANCE * model.scale,
        layer_model.RIDGE * model.scale,
    )
    point /= (np.bincount(model.group, point) / sums)[model.group]
    return value + objective.quadratic.energy + objective.fixed, point


def best(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    before: np.ndarray | None,
    guide: Guide | None,
) -> Found:
    """Return the best that was found from the last frame's point and from others.

    The others are tried where the bound leaves room: the relaxation, the best layer alone, on the
    first frame draws, and layers without weight with the extreme that promises most. So no layer
    alone is ever better, and none stays dead that need not. The last frame's own descendant is
    kept unless another is better by more than rounding, so that nothing flickers between equals.

    Parameters
    ----------
    model, objective : see `layer_model` and `layer_objective`
    before : (R * J + K,) float array, the last frame's point; None on the first frame
    guide : of the last frame; None on the first
    """
    regions, layers, _ = model.sizes
    enough = CLOSE_ENOUGH * model.scale
    starts = layer_starts.draws(model, DRAWS, 0) if before is None else [before]
    value, point = descend(model, objective, starts[0])
    heavy = point[: regions * layers].reshape(regions, layers).argmax(axis=0)
    share = (np.arange(regions)[:, None] == heavy).astype(float).ravel()
    if guide is None:
        guide = Guide(np.full(len(model.first), 1.0 / len(model.layer)), point[regions * layers :])
    relaxed, bound = layer_relaxation.solve(model, objective, share, guide.relaxed)
    alone = guide.alone
    if value - bound > enough:
        held = point[regions * layers :]
        starts.append(layer_relaxation.factors(model, relaxed, held))
        points, alone = layer_starts.singles(model, objective, held, alone, enough)
        values = [layer_objective.value(model, objective, single) for single in points]
        starts.append(points[int(np.argmin(values))])
        for start in starts[1:]:
            other, place = descend(model, objective, start)
            if other < value - enough:
                value, point = other, place
        if len(layer_starts.without_weight(model, point)):
            other, place = descend(model, objective, layer_starts.revived(model, objective, point))
            if other < value - enough:
                value, point = other, place
    if before is not None:
        value, point = _held(model, objective, before, value, point)
    return Found(value, point, bound, Guide(relaxed, alone))


def _held(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    before: np.ndarray,
    value: float,
    point: np.ndarray,
) -> tuple[float, np.ndarray]:
    """Give a layer without weight, which leaves its coefficients open, the last frame's."""
    regions = len(model.masks)
    for layer in layer_starts.without_weight(model, point):
        held = np.where(model.group == regions + layer, before, point)
        other = layer_objective.value(model, objective, held)
        if other <= value + CLOSE_ENOUGH * model.scale:
            value, point = other, held
    return value, point
