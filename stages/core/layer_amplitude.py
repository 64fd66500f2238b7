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
    that then would fall below one is closed again. So nothing is ever worse than at amplitude one.

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
    regions, layers, _ = model.sizes
    opened = _wanting(model, objective, point)
    while opened.any():
        v, coefficients = _descended(model, objective, point, ridge, opened, beyond)
        sums = v.sum(axis=1)
        if (sums[opened] >= 1.0).all():
            amplitudes = np.where(opened, np.minimum(sums, 1.0 + beyond), 1.0)
            return np.append(v / sums[:, None], coefficients), amplitudes
        opened &= sums >= 1.0
    return point, np.ones(regions)


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
    regions, layers, count = model.sizes
    limit = np.where(opened, 1.0 + beyond, 1.0)
    size = np.repeat(limit, layers)
    of_u = size[model.first]
    quadratic = objective.quadratic._replace(
        linear=objective.quadratic.linear * of_u,
        gram=objective.quadratic.gram * np.outer(of_u, of_u),
    )
    ones, spare = np.ones(count), np.where(opened, 1.0 - 1.0 / limit, 1.0)
    size = np.append(size, ones)
    wide = layer_objective.Objective(
        quadratic,
        _with_spare(model, objective.pull * size**2, np.where(opened, ridge * limit**2, 0.0)),
        _with_spare(model, objective.target / size, spare),
        objective.fixed,
    )
    start = _with_spare(model, point / size, spare)
    _, found = layer_search.descend(_roomy(model, opened), wide, start)
    split = regions * (layers + 1)
    return found[:split].reshape(regions, -1)[:, :-1] * limit[:, None], found[split:]


def _with_spare(model, values, spare):
    """Return values (R * J + K,) with one more (R,) after the weights of each mask."""
    regions, layers, _ = model.sizes
    weights = values[: regions * layers].reshape(regions, layers)
    return np.append(np.column_stack([weights, spare]), values[regions * layers :])


def _roomy(model, opened):
    """Return the model with a spare weight in each mask; closed masks have it to themselves."""
    regions, layers, count = model.sizes
    masks = np.arange(regions)
    alone = np.where(opened, masks, regions + layers + masks)
    group = np.column_stack([np.tile(masks[:, None], layers), alone])
    return model._replace(
        first=model.first + model.mask_group,
        second=model.second + regions,
        group=np.append(group, model.group[regions * layers :]),
    )
