"""Find points from which to solve the layers, besides the last frame's."""

import numba
import numpy as np

from stages.core import layer_kernel, layer_model, layer_objective

UNSEEN = 1e-6


def singles(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    coefficients: np.ndarray,
    alone: np.ndarray,
    tolerance: float,
) -> tuple[list[np.ndarray], np.ndarray]:
    """Return, for each layer, the best point at which it alone has all weights.

    Parameters
    ----------
    model, objective : see `layer_model` and `layer_objective`
    coefficients : (K,) float array, kept where a layer has no weight
    alone : (K,) float array, where to start, on the simplices
    tolerance : float, of the multipliers

    Returns
    -------
    points : J arrays (R * J + K,)
    alone : (K,) float array, the coefficients of each layer alone
    """
    regions, layers, _ = model.sizes
    quadratic, pull, target, _ = objective
    alone = alone.copy()
    hessian, gradient = _separate(
        quadratic.gram,
        model.pairs,
        quadratic.linear,
        model.layer,
        pull[regions * layers :],
        target[regions * layers :],
        alone,
    )
    ridge = layer_model.RIDGE * model.scale
    layer_kernel.minimise_quadratic(hessian, gradient, model.layer, alone, tolerance, ridge)
    points = []
    for j in range(layers):
        point = np.zeros(len(model.group))
        point[j : regions * layers : layers] = 1.0
        point[regions * layers :] = np.where(model.layer == j, alone, coefficients)
        points.append(point)
    return points, alone


@numba.njit(cache=True)
def _separate(gram, pairs, linear, layer, pull, target, point):
    """Return Hessian and gradient of the objectives of all layers, each alone, as one quadratic."""
    count = len(layer)
    hessian = np.zeros((count, count))
    for p in range(len(pairs)):
        start, other = pairs[p, 0] * count, pairs[p, 1] * count
        for k in range(count):
            row, block = hessian[k], gram[start + k, other : other + count]
            for j in range(count):
                row[j] += 2.0 * block[j]
    gradient = np.zeros(count)
    for i in range(len(linear)):
        gradient[i % count] -= 2.0 * linear[i]
    for k in range(count):
        gradient[k] -= 2.0 * pull[k] * target[k]
        hessian[k, k] += 2.0 * pull[k]
        for j in range(count):
            if layer[j] != layer[k]:
                hessian[k, j] = 0.0
            gradient[k] += hessian[k, j] * point[j]
    return hessian, gradient


def revived(
    model: layer_model.Model, objective: layer_objective.Objective, point: np.ndarray
) -> np.ndarray:
    """Return a point with the layers that have no weight set to the extreme that promises most.

    Under mask l a little weight on extreme k changes the data term by its slope there less the
    mean slope of what has the weight now; the promise of k is the sum over masks of all that falls.
    Coefficients of no weight cost nothing to set, and weight comes by descent.

    Parameters
    ----------
    model, objective : see `layer_model` and `layer_objective`
    point : (R * J + K,) float array
    """
    regions, layers, count = model.sizes
    u = point[model.first] * point[model.second]
    slope = (objective.quadratic.gram @ u - objective.quadratic.linear).reshape(regions, count)
    mean = np.sum(slope * u.reshape(regions, count), axis=1, keepdims=True)
    promise = np.maximum(mean - slope, 0.0).sum(axis=0)
    changed = point.copy()
    for layer in without_weight(model, point):
        own = np.flatnonzero(model.layer == layer)
        changed[regions * layers + own] = own == own[promise[own].argmax()]
    return changed


def without_weight(model: layer_model.Model, point: np.ndarray) -> np.ndarray:
    """Return the layers that have no weight under any mask."""
    regions, layers, _ = model.sizes
    return np.flatnonzero(point[: regions * layers].reshape(regions, layers).max(axis=0) < UNSEEN)


def draws(model: layer_model.Model, count: int, seed: int) -> list[np.ndarray]:
    """Return points drawn evenly from the simplices, the first of them the centre."""
    rng = np.random.default_rng(seed)
    points = [np.ones(len(model.group))]
    points += [rng.exponential(size=len(model.group)) for _ in range(count)]
    return [point / np.bincount(model.group, point)[model.group] for point in points]
