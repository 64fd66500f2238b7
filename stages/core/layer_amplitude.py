"""Let layers exceed their extremes: one bounded amplitude per layer, in turn with its factors."""

import numpy as np

from stages.core import layer_model, layer_objective, layer_search

ROUNDS = 3
SWEEPS = 200


def follow(
    model: layer_model.Model,
    objective: layer_objective.Objective,
    point: np.ndarray,
    pull: float,
    centre: np.ndarray,
    beyond: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Lower the objective with ``u_lk = w_lj s_j a_k``, plus ``pull |s - centre|^2``.

    Amplitudes s, given weights and coefficients, are a bounded least squares; weights and
    coefficients, given amplitudes, are the same problem as before with larger extremes.

    Parameters
    ----------
    model, objective : see `layer_model` and `layer_objective`
    point : (R * J + K,) float array, the best at amplitude one
    pull : float, above zero
    centre : (J,) float array
    beyond : float, how far an amplitude may exceed one

    Returns
    -------
    point : (R * J + K,) float array
    amplitudes : (J,) float array
    """
    regions, layers, _ = model.sizes
    of_layer = np.tile(model.layer, regions)
    quadratic, amplitudes = objective.quadratic, np.ones(layers)
    for turn in range(ROUNDS):
        if turn:
            size = amplitudes[of_layer]
            larger = layer_model.Quadratic(
                quadratic.energy,
                quadratic.linear * size,
                quadratic.gram * np.outer(size, size),
                quadratic.span,
            )
            _, point = layer_search.descend(model, objective._replace(quadratic=larger), point)
        u = point[model.first] * point[model.second]
        parts = np.where(of_layer == np.arange(layers)[:, None], u, 0.0)
        products, linear = parts @ quadratic.gram @ parts.T, parts @ quadratic.linear
        amplitudes = bounded(products, linear, pull, centre, beyond)
    return point, amplitudes


def bounded(
    products: np.ndarray,
    linear: np.ndarray,
    pull: float,
    centre: np.ndarray,
    beyond: float,
) -> np.ndarray:
    """Minimise ``s' products s - 2 linear's + pull |s - centre|^2`` over ``1 <= s <= 1 + beyond``.

    Parameters
    ----------
    products : (J, J) float array, inner products of the layers' displacements
    linear : (J,) float array, their inner products with the frame
    pull : float, above zero
    centre : (J,) float array
    beyond : float, how far an amplitude may exceed one

    Returns
    -------
    amplitudes : (J,) float array
    """
    point = np.ones(len(linear))
    for _ in range(SWEEPS):
        before = point.copy()
        for j in range(len(point)):
            others = products[j] @ point - products[j, j] * point[j]
            best = (linear[j] + pull * centre[j] - others) / (products[j, j] + pull)
            point[j] = min(max(best, 1.0), 1.0 + beyond)
        if np.abs(point - before).max() < 1e-9:
            break
    return point
