"""Score layered solutions: errors, SLSQP from the same starts, what smoothing costs."""

import time

import numpy as np
import scipy.optimize

from bench import layer_faces
from stages.core import (
    layer_model,
    layer_objective,
    layer_published,
    layer_search,
    layer_solver,
    layer_starts,
)

DEAD = 1e-6


def rms(values, axis=None) -> np.ndarray:
    """Return the root of the mean square."""
    return np.sqrt(np.mean(np.square(values), axis=axis))


def mask_errors(face, solution, exact) -> np.ndarray:
    """Return the RMS error (R,) of what the layers compose to under each mask [mm]."""
    wrong = layer_faces.composed(face, solution.weights, solution.coefficients) - exact
    return np.array([rms((wrong * face.unit)[:, mask > 0.5]) for mask in face.masks])


def single_residuals(model, frames) -> np.ndarray:
    """Return the data term (T, J) of the best point at which one layer alone has all weights."""
    terms = []
    centre = layer_starts.draws(model, 0, 0)[0]
    coefficients = centre[-len(model.layer) :]
    for frame in frames:
        quadratic = layer_model.project(model, frame)
        objective = layer_objective.at(model, quadratic, quadratic, 0.0, 0.0, None)
        points, _ = layer_starts.singles(model, objective, coefficients, coefficients, 1e-12)
        terms.append([layer_objective.value(model, objective, point) for point in points])
    return np.array(terms)


def residual_mm(face, model, frame, point) -> float:
    """Return the RMS residual of a frame at the solver's point [mm]."""
    u = (point[model.first] * point[model.second]).reshape(len(model.masks), -1)
    shape = sum(mask * (face.basis @ row) for mask, row in zip(face.masks, u, strict=True))
    return float(rms((frame - shape) * face.unit))


def sequential(model, objective, start, tolerance) -> np.ndarray:
    """Return the point to which SLSQP comes from a start, to a tolerance of one's choice."""
    sums = np.equal.outer(np.arange(model.group.max() + 1), model.group).astype(float)
    found = scipy.optimize.minimize(
        lambda point: layer_objective.value(model, objective, point),
        start,
        jac=lambda point: layer_published.gradient(model, objective, point),
        method="SLSQP",
        bounds=scipy.optimize.Bounds(0.0, 1.0),
        constraints={"type": "eq", "fun": lambda point: sums @ point - 1.0, "jac": lambda _: sums},
        options={"ftol": tolerance, "maxiter": 500},
    )
    positive = np.maximum(found.x, 0.0)
    return positive / np.bincount(model.group, positive)[model.group]


def against_slsqp(model, settings, performance, frames, tolerance) -> dict[str, np.ndarray]:
    """Solve some frames by SLSQP, by the same descent, and in whole, from the same last state.

    Returns
    -------
    columns : (N,) float arrays
        objectives and seconds of one processor: `slsqp`, `descent`, `whole`; and the `bound`
    """
    columns = {name: [] for name in ("slsqp", "descent", "whole", "bound")}
    columns |= {f"{name} s": [] for name in ("slsqp", "descent", "whole")}
    state = None
    for index in range(int(max(frames)) + 1):
        frame, near = performance.frames[index], float(performance.closeness[index])
        last, start = state, time.process_time()
        solution, state = layer_solver.solve_frame(model, settings, frame, near, last)
        taken = time.process_time() - start
        if last is None or index not in frames:
            continue
        before = np.concatenate([last.weights.ravel(), last.coefficients])
        quadratic = layer_model.project(model, frame)
        objective = layer_objective.at(model, quadratic, quadratic, near, settings.temporal, before)
        start = time.process_time()
        value, _ = layer_search.descend(model, objective, before)
        columns["descent s"].append(time.process_time() - start)
        start = time.process_time()
        point = sequential(model, objective, before, tolerance)
        columns["slsqp s"].append(time.process_time() - start)
        columns["slsqp"].append(layer_objective.value(model, objective, point))
        columns["descent"].append(value)
        columns["whole"].append(float(solution.objective))
        columns["bound"].append(float(solution.bound))
        columns["whole s"].append(taken)
    return {name: np.array(values) for name, values in columns.items()}


def brute_force(model, objective, draws, seed) -> float:
    """Return the lowest objective of descents from many drawn points."""
    starts = layer_starts.draws(model, draws, seed)
    return min(layer_search.descend(model, objective, start)[0] for start in starts)


def revivable(model, solution, frames, draws) -> tuple[int, float]:
    """Return of how many frames a layer is without weight, and what share many starts better."""
    found = np.flatnonzero((solution.weights.max(axis=1) < DEAD).any(axis=1))
    better = []
    for index in found[np.linspace(0, len(found) - 1, min(len(found), 20)).astype(int)]:
        quadratic = layer_model.project(model, frames[index])
        objective = layer_objective.at(model, quadratic, quadratic, 0.0, 0.0, None)
        best = brute_force(model, objective, draws, int(index))
        better.append(best < solution.objective[index] - 1e-6)
    return len(found), float(np.mean(better)) if better else 0.0


def dead(solution) -> float:
    """Return the share of frames and layers without weight under any mask."""
    return float(np.mean(solution.weights.max(axis=1) < DEAD))


def jitter(face, solution) -> float:
    """Return the RMS second difference of what the layers compose to [mm per frame squared]."""
    shape = layer_faces.composed(face, solution.weights, solution.coefficients) * face.unit
    return float(rms(np.diff(shape, 2, axis=0)))


def peaks_kept(closing, truth, closeness=None) -> np.ndarray:
    """Return what is left (N,) of a curve's peaks, at the truth's frames; of those of closed lips.

    Those of all frames where no closeness is given.
    """
    middle = truth[1:-1]
    peak = 1 + np.flatnonzero((middle > truth[:-2]) & (middle >= truth[2:]) & (middle > 0.5))
    if closeness is not None:
        peak = peak[closeness[peak] > 0.9]
    return closing[peak] / truth[peak]


def closed_lips(model, face, performance, lip_bias) -> tuple[np.ndarray, np.ndarray]:
    """Return residuals (R,) where lips are closed [mm], and what is left of the blinks there."""
    settings = layer_solver.Settings(0.05, 0.0, lip_bias)
    got = layer_solver.solve(model, settings, performance.frames, performance.closeness)
    shape = layer_faces.composed(face, got.weights, got.coefficients)
    wrong = ((shape - performance.frames) * face.unit)[performance.closeness > 0.9]
    residuals = np.array([rms(wrong[:, mask > 0.5]) for mask in face.masks])
    kept = peaks_kept(layer_faces.closing(face, shape), performance.blink, performance.closeness)
    return residuals, kept
