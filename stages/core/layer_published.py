"""Solve the layers as published: interior point, then sequential quadratic programming.

Kholgade 2011, section 4: each frame from the parameters of the last, the first at random, both
methods to a function tolerance of 1e-6. The methods are SciPy's `trust-constr` and `SLSQP`; the
objective is that of `layer_solver`, by the same Gram matrices, with its analytic gradient.
"""

import numpy as np
import scipy.optimize

from stages.core import layer_model, layer_objective, layer_solver, layer_starts

TOLERANCE = 1e-6


def gradient(
    model: layer_model.Model, objective: layer_objective.Objective, point: np.ndarray
) -> np.ndarray:
    """Return the gradient of a frame's objective by the solver's point."""
    _, linear, gram, _ = objective.quadratic
    slope = 2.0 * (gram @ (point[model.first] * point[model.second]) - linear)
    size = len(point)
    by_weights = np.bincount(model.first, slope * point[model.second], minlength=size)
    by_coefficients = np.bincount(model.second, slope * point[model.first], minlength=size)
    pulled = 2.0 * objective.pull * (point - objective.target)
    return by_weights + by_coefficients + pulled


def sequential(
    model: layer_model.Model, objective: layer_objective.Objective, start: np.ndarray
) -> np.ndarray:
    """Return the point to which SLSQP comes from a start."""
    sums = np.equal.outer(np.arange(model.group.max() + 1), model.group).astype(float)
    found = scipy.optimize.minimize(
        lambda point: layer_objective.value(model, objective, point),
        start,
        jac=lambda point: gradient(model, objective, point),
        method="SLSQP",
        bounds=scipy.optimize.Bounds(0.0, 1.0),
        constraints={"type": "eq", "fun": lambda point: sums @ point - 1.0, "jac": lambda _: sums},
        options={"ftol": TOLERANCE, "maxiter": 500},
    )
    return _onto_simplices(model, found.x)


def interior(
    model: layer_model.Model, objective: layer_objective.Objective, start: np.ndarray
) -> np.ndarray:
    """Return the point to which the interior point method comes from a start."""
    sums = np.equal.outer(np.arange(model.group.max() + 1), model.group).astype(float)
    found = scipy.optimize.minimize(
        lambda point: layer_objective.value(model, objective, point),
        _onto_simplices(model, start + 1e-3),
        jac=lambda point: gradient(model, objective, point),
        method="trust-constr",
        hess=scipy.optimize.BFGS(),
        bounds=scipy.optimize.Bounds(0.0, 1.0),
        constraints=scipy.optimize.LinearConstraint(sums, 1.0, 1.0),
        options={"gtol": TOLERANCE, "xtol": TOLERANCE, "barrier_tol": TOLERANCE, "maxiter": 500},
    )
    return _onto_simplices(model, found.x)


def _onto_simplices(model: layer_model.Model, point: np.ndarray) -> np.ndarray:
    """Return a point without the rounding that leaves its simplices."""
    positive = np.maximum(point, 0.0)
    return positive / np.bincount(model.group, positive)[model.group]


def solve(
    model: layer_model.Model,
    settings: layer_solver.Settings,
    frames: np.ndarray,
    closeness: np.ndarray,
    seed: int = 0,
) -> layer_solver.Solution:
    """Solve a sequence as published; there is no lower bound, and no amplitude but one.

    Parameters
    ----------
    model, settings, frames, closeness : see `layer_solver.solve`
    seed : int, of the first frame's random start

    Returns
    -------
    solution : as of `layer_solver.solve`, the bound minus infinity

    Raises
    ------
    ValueError
        if arrays do not fit the model or each other, or amplitudes may exceed one
    """
    layer_solver.check(model, settings, frames, closeness)
    if settings.beyond > 0.0:
        raise ValueError(f"beyond must be 0 for the published solver, got {settings.beyond}")
    point, before = layer_starts.draws(model, 1, seed)[1], None
    solutions, ones = [], np.ones(model.sizes[0])
    for frame, near in zip(frames, closeness, strict=True):
        quadratic = layer_model.project(model, frame)
        if quadratic is None:
            solutions.append(layer_solver.nothing(model))
            continue
        objective = layer_solver.stated(model, settings, frame, quadratic, float(near), before)
        point = sequential(model, objective, interior(model, objective, point))
        before = point
        value = layer_objective.value(model, objective, point)
        outside = layer_model.outside(model, quadratic, point)
        described = (model, quadratic, point, ones, value, -np.inf, outside)
        solutions.append(layer_solver.describe(*described))
    return layer_solver.stacked(solutions)
