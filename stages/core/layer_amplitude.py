"""Let the layers of a mask exceed one in sum, each mask by an amplitude of its own.

Weights that sum to one leave an emotion nothing to say in a mouth that speaks in full, while real
faces show both at once. With ``v_lj = s_l w_lj``, amplitude s_l in 1..1 + beyond, the sum itself is
bounded: ``1 <= sum_j v_lj <= 1 + beyond``. One amplitude for each layer of a mask reaches the same
v, no more. What a mask leaves of 1 + beyond is one more weight of its simplex, so that v and the
coefficients are found together, by the solver's own descent.
"""

import numpy as np

from stages.core import layer_model, layer_objective, layer_search


def follow(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    point: np.ndarray,
    ridge: float,
    beyond: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Lower the objective of v and the coefficients, plus ``ridge sum_l (s_l - 1)^2``.

    Starts from the best at amplitude one, and opens the masks whose sum would rather be larger; one
    that then falls below one is shut for good. So nothing is ever worse than at amplitude one.

    Parameters
    ----------
    model, objective : see `layer_model` and `layer_objective`; the pulls of weights are those of v
    point : (R * J + K,) float array, the best at amplitude one
    ridge : float, at least 0
    beyond : float above zero, how far an amplitude may exceed one

    Returns
    -------
    point : (R * J + K,) float array, weights w and coefficients
    amplitudes : (R,) float array
    """
    opened = _wanting(model, objective, point)
    shut = np.zeros(len(opened), bool)
    while opened.any():
        v, coefficients = _descended(model, objective, point, ridge, opened, beyond)
        sums = v.sum(axis=1)
        shut |= opened & (sums < 1.0)
        more = _wanting(model, objective, np.append(v, coefficients)) & ~opened
        changed = (opened | more) & ~shut
        if np.array_equal(changed, opened):
            amplitudes = np.where(opened, np.minimum(sums, 1.0 + beyond), 1.0)
            return np.append(v / sums[:, None], coefficients), amplitudes
        opened = changed
    return point, np.ones(len(model.masks))


def _wanting(model, objective, point):
    """Return the masks (R,) whose objective falls as their weights grow."""
    regions, layers, _ = model.sizes
    _, linear, gram, _ = objective.quadratic
    u = point[model.first] * point[model.second]
    rise = np.bincount(model.first, (gram @ u - linear) * u, minlength=regions * layers)
    weights = slice(0, regions * layers)
    rise += objective.pull[weights] * (point - objective.target)[weights] * point[weights]
    return rise.reshape(regions, layers).sum(axis=1) < 0.0


def _descended(model, objective, point, ridge, opened, beyond):
    """Return v (R, J) and coefficients (K,) to which SQP comes from a point."""
    regions, layers, _ = model.sizes
    spare = np.where(opened, beyond, 1.0)
    held = np.where(opened, ridge, 0.0)
    wide = objective._replace(
        pull=_with_spare(model, objective.pull, held),
        target=_with_spare(model, objective.target, spare),
    )
    roomy, start = _roomy(model, opened), _with_spare(model, point, spare)
    sums = np.ones(roomy.group.max() + 1)
    sums[:regions] += np.where(opened, beyond, 0.0)
    _, found = layer_search.descend(roomy, wide, start, sums)
    split = regions * (layers + 1)
    return found[:split].reshape(regions, -1)[:, :-1], found[split:]


def _with_spare(model, values, spare):
    """Return values (R * J + K,) with one more (R,) after the weights of each mask."""
    regions, layers, _ = model.sizes
    weights = values[: regions * layers].reshape(regions, layers)
    return np.append(np.column_stack([weights, spare]), values[regions * layers :])


def _roomy(model, opened):
    """Return the model with a spare weight in each mask; closed masks do not share theirs."""
    regions, layers, _ = model.sizes
    masks = np.arange(regions)
    alone = np.where(opened, masks, regions + layers + masks)
    group = np.column_stack([np.tile(masks[:, None], layers), alone])
    return model._replace(
        first=model.first + model.mask_group,
        second=model.second + regions,
        group=np.append(group, model.group[regions * layers :]),
    )
