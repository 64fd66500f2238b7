"""Relax the layers to one convex problem over all extremes under each mask, with a proven bound.

With ``u_lk = w_lj a_k`` every mask's displacements lie on one simplex over the K extremes. What the
relaxation forgets is that the masks share the coefficients, so its minimum is never above the
layered one. Weights are sums of u, so that what pulls them enters as it is; of a pull on the
coefficients, ``|a_j - t_j|^2 >= sum_l share_lj w_lj^2 |a_j - t_j|^2``, the latter a quadratic of u.
"""

import numba
import numpy as np

from stages.core import layer_kernel, layer_model, layer_objective


@numba.njit(cache=True)
def _assemble(gram, linear, layer, pull, target, share):
    """Return Hessian and linear term of the relaxed objective."""
    count, weights = len(layer), len(share)
    layers = weights * count // len(linear)
    hessian, slope = np.empty((len(linear), len(linear))), np.empty(len(linear))
    ahead, square = np.empty(count), np.zeros(layers)
    for k in range(count):
        ahead[k] = pull[weights + k] * target[weights + k]
        square[layer[k]] += ahead[k] * target[weights + k]
    for row in range(len(linear)):
        for column in range(len(linear)):
            hessian[row, column] = 2.0 * gram[row, column]
        mask, k = row // count, row % count
        entry = mask * layers + layer[k]
        portion = 2.0 * share[entry]
        slope[row] = -2.0 * (linear[row] + pull[entry] * target[entry])
        hessian[row, row] += portion * pull[weights + k]
        for other in range(count):
            if layer[other] == layer[k]:
                curve = square[layer[k]] - ahead[k] - ahead[other]
                hessian[row, mask * count + other] += 2.0 * pull[entry] + portion * curve
    return hessian, slope


@numba.njit(cache=True)
def _bound(hessian, slope, group, point):
    """Return the Frank-Wolfe lower bound of a convex quadratic over simplices."""
    least = np.empty(len(point))
    for i in range(len(point)):
        least[group[i]] = np.inf
    curved = np.zeros(len(point))
    for i in range(len(point)):
        if point[i] != 0.0:
            for j in range(len(point)):
                curved[j] += hessian[i, j] * point[i]
    bound = 0.0
    for i in range(len(point)):
        bound -= 0.5 * curved[i] * point[i]
        least[group[i]] = min(least[group[i]], curved[i] + slope[i])
    for j in range(group[len(point) - 1] + 1):
        bound += least[j]
    return bound


def solve(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    share: np.ndarray,
    start: np.ndarray,
) -> tuple[np.ndarray, float]:
    """Minimise the relaxation; return displacements (R * K,) and a lower bound of the objective.

    The bound, ``f(u) + min_v grad f(u)'(v - u)`` over the simplices, holds at whatever u the
    iterations end.

    Parameters
    ----------
    model, objective : see `layer_model` and `layer_objective`; pulls are alike within a layer
    share : (R * J,) float array
        how a layer's pull on coefficients is shared among the masks, at most one in sum
    start : (R * K,) float array, on its simplices
    """
    quadratic, pull, target, fixed = objective
    weights = len(share)
    hessian, slope = _assemble(quadratic.gram, quadratic.linear, model.layer, pull, target, share)
    point = start.copy()
    layer_kernel.minimise_quadratic(
        hessian,
        slope + hessian @ point,
        model.mask_group,
        point,
        1e-9 * model.scale,
        layer_model.RIDGE * model.scale,
    )
    fixed += quadratic.energy + np.sum((pull * target**2)[:weights])
    rounding = 1e-12 * max(quadratic.energy, model.scale)
    return point, _bound(hessian, slope, model.mask_group, point) + fixed - rounding


def factors(
    model: layer_model.Model, displacements: np.ndarray, otherwise: np.ndarray
) -> np.ndarray:
    """Return the point nearest in kind: ``w_lj = sum_k u_ljk``, ``a_j ~ sum_l u_lj``.

    Parameters
    ----------
    model : see `layer_model`
    displacements : (R * K,) float array, on a simplex under each mask
    otherwise : (K,) float array, the coefficients of layers without any displacement
    """
    regions, layers, count = model.sizes
    weights = np.bincount(model.first, displacements, minlength=regions * layers)
    total = displacements.reshape(regions, count).sum(axis=0)
    size = np.bincount(model.layer, total, minlength=layers)[model.layer]
    coefficients = np.where(size > 1e-12, total / np.maximum(size, 1e-12), otherwise)
    return np.concatenate([weights, coefficients])
