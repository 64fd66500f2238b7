"""Find points from which to solve the layers, besides the last frame's."""

import numpy as np

from stages.core import layer_kernel, layer_model, layer_objective


def singles(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    coefficients: np.ndarray,
    tolerance: float,
) -> list[np.ndarray]:
    """Return, for each layer, the best point at which it alone has all weights.

    Parameters
    ----------
    model, objective : see `layer_model` and `layer_objective`
    coefficients : (K,) float array, kept where a layer has no weight
    tolerance : float, of the multipliers
    """
    regions, layers, count = model.sizes
    shape = (regions, count, regions, count)
    gram = objective.quadratic.gram.reshape(shape).sum(axis=(0, 2))
    linear = objective.quadratic.linear.reshape(regions, count).sum(axis=0)
    pull, target = (part[regions * layers :] for part in (objective.pull, objective.target))
    points = []
    for j in range(layers):
        own = np.flatnonzero(model.layer == j)
        hessian = 2.0 * (gram[np.ix_(own, own)] + np.diag(pull[own]))
        slope = -2.0 * (linear[own] + pull[own] * target[own])
        chosen = coefficients.copy()
        start = np.ascontiguousarray(coefficients[own])
        layer_kernel.minimise_quadratic(
            hessian,
            hessian @ start + slope,
            np.zeros(len(own), np.int64),
            start,
            tolerance,
            layer_model.RIDGE * model.scale,
        )
        chosen[own] = start
        weights = np.zeros((regions, layers))
        weights[:, j] = 1.0
        points.append(np.concatenate([weights.ravel(), chosen]))
    return points


def draws(model: layer_model.Model, count: int, seed: int) -> list[np.ndarray]:
    """Return points drawn evenly from the simplices, the first of them the centre."""
    rng = np.random.default_rng(seed)
    points = [np.ones(len(model.group))]
    points += [rng.exponential(size=len(model.group)) for _ in range(count)]
    return [point / np.bincount(model.group, point)[model.group] for point in points]
