"""A linear dynamical system of an actor's curves: learnt by EM, for smoothing and for gaps.

Shumway & Stoffer 1982, "An approach to time series smoothing and forecasting using the EM
algorithm"; for gaps of motion capture Li et al. 2009, "DynaMMo". Hidden components z follow their
own last `LAGS` frames, curves x follow them:

    z_t = A [z_t-1 .. z_t-LAGS] + w,  w ~ N(0, Q);   x_t = m + C z_t + v,  v ~ N(0, diag R).

EM raises the likelihood of what was observed; it starts from principal components and the
least-squares regression of each frame on those before. `kalman` gives the expectations.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from bench import kalman
from stages.core import pca, resample

LAGS = 2
ROUNDS = 10
# of the variance that components explain together, and how many at most
EXPLAINED, MOST = 0.995, 16
# frames that EM sees; of a longer take its beginning
MOST_FRAMES = 6000
# variances stay above this part of the curves' mean variance
LEAST = 1e-6


class LinearDynamics(NamedTuple):
    """Hold a linear dynamical system of K curves and C components.

    Attributes
    ----------
    mean : (K,) float array, m
    loadings : (K, C) float array, C
    transition : (C, LAGS C) float array, A
    drive : (C, C) float array, Q
    noise : (K,) float array, R
    """

    mean: np.ndarray
    loadings: np.ndarray
    transition: np.ndarray
    drive: np.ndarray
    noise: np.ndarray


def learn(takes: Sequence[np.ndarray]) -> LinearDynamics:
    """Learn from takes of one frame rate.

    Parameters
    ----------
    takes : (T, K) float arrays; NaN where not observed

    Raises
    ------
    ValueError
        if the takes do not fit each other, nothing moves in them, or they are too short
    """
    if len({take.shape[1:] for take in takes}) != 1:
        shapes = ", ".join(str(take.shape) for take in takes)
        raise ValueError(f"takes {shapes} do not belong together")
    seen, left = [], MOST_FRAMES
    for take in takes:
        seen.append(take[:left])
        left -= len(seen[-1])
        if left <= 0:
            break
    model = _start(seen)
    for _ in range(ROUNDS):
        model = _improved(model, seen)
    return model


def smooth(
    model: LinearDynamics, values: np.ndarray, noise: np.ndarray | float = 1.0
) -> np.ndarray:
    """Return what the system takes for the curves without their noise.

    Parameters
    ----------
    model : a system of K curves
    values : (T, K) float array; NaN where not observed
    noise : (K,) float array or number, factor on the variance of the noise; 0 keeps a curve

    Returns
    -------
    (T, K) float array, finite
    """
    factor = np.broadcast_to(np.asarray(noise, float), model.noise.shape)
    trusted = model._replace(noise=model.noise * np.where(factor > 0.0, factor, 1.0))
    expected = kalman.smooth(_system(trusted), values - model.mean).mean
    made = model.mean + expected[:, : model.loadings.shape[1]] @ model.loadings.T
    return np.where((factor == 0.0) & np.isfinite(values), values, made)


def fill(model: LinearDynamics, values: np.ndarray) -> np.ndarray:
    """Fill gaps; what was observed stays, and what the system leaves of it is carried across.

    Parameters
    ----------
    model : a system of K curves
    values : (T, K) float array; NaN where not observed, every curve somewhere observed

    Returns
    -------
    (T, K) float array, finite
    """
    made = smooth(model, values)
    rest = values - made
    for curve, known in enumerate(np.isfinite(values).T):
        made[:, curve] += resample.linear(rest[known, curve], *resample.neighbours(known))
    return np.where(np.isfinite(values), values, made)


def _system(model: LinearDynamics) -> kalman.System:
    """Return the system with the last frames as its state, its start spread as the clip is."""
    components = model.loadings.shape[1]
    size = LAGS * components
    transition = np.eye(size, k=-components)
    transition[:components] = model.transition
    # past frames are known; a little is added so that covariances can be inverted
    drive = np.eye(size) * LEAST * np.trace(model.drive) / components
    drive[:components, :components] = model.drive
    return kalman.System(transition, drive, model.loadings, model.noise)


def _start(takes: Sequence[np.ndarray]) -> LinearDynamics:
    """Return principal components and the regression of frames on those before."""
    whole = [np.isfinite(take).all(axis=1) for take in takes]
    rows = np.concatenate([take[known] for take, known in zip(takes, whole, strict=True)])
    if len(rows) < 2 or not np.ptp(rows, axis=0).any():
        raise ValueError(f"{len(rows)} whole frames of {rows.shape[1]} curves show no motion")
    found = pca.fit(rows)
    share = np.cumsum(found.variance) / found.variance.sum()
    count = min(int(np.searchsorted(share, EXPLAINED)) + 1, MOST, len(found.variance))
    loadings = found.components[:count].T
    givens, wanted = [], []
    for take in takes:
        scores = (take - found.mean) @ loadings
        last = [scores[LAGS - lag : len(scores) - lag] for lag in range(1, LAGS + 1)]
        given, next_ = np.concatenate(last, axis=1), scores[LAGS:]
        known = np.isfinite(given).all(axis=1) & np.isfinite(next_).all(axis=1)
        givens.append(given[known])
        wanted.append(next_[known])
    given, next_ = np.concatenate(givens), np.concatenate(wanted)
    if len(given) <= LAGS * count:
        raise ValueError(f"{len(given)} runs of frames do not tell how {count} components move")
    squares = given.T @ given
    squares += LEAST * np.trace(squares) / len(squares) * np.eye(len(squares))
    transition = np.linalg.solve(squares, given.T @ next_).T
    off = next_ - given @ transition.T
    least = LEAST * rows.var(axis=0).mean()
    residual = rows - found.mean - (rows - found.mean) @ loadings @ loadings.T
    # of white noise, second differences have six times the variance
    rough = [np.diff(take, 2, axis=0) for take in takes]
    white = np.nanmean(np.concatenate(rough) ** 2, axis=0) / 12
    noise = np.maximum(np.maximum(residual.var(axis=0), white), least)
    drive = off.T @ off / len(off) + least * np.eye(count)
    return LinearDynamics(found.mean, loadings, transition, drive, noise)


def _improved(model: LinearDynamics, takes: Sequence[np.ndarray]) -> LinearDynamics:
    """Return the system after one round of EM (Shumway & Stoffer equations 9 to 14)."""
    curves, count = model.loadings.shape
    size = LAGS * count
    before, across, after = (np.zeros((size, size)) for _ in range(3))
    shared, crossed = np.zeros((curves, count, count)), np.zeros((curves, count))
    power, shown, steps = np.zeros(curves), np.zeros(curves), 0
    for take in takes:
        mean, covariance, gain = kalman.smooth(_system(model), take - model.mean)
        squares = mean[:, :, None] * mean[:, None, :] + np.stack(covariance)
        before += squares[:-1].sum(axis=0)
        after += squares[1:].sum(axis=0)
        across += mean[1:].T @ mean[:-1]
        across += sum(covariance[t + 1] @ gain[t].T for t in range(len(gain)))
        seen = np.isfinite(take)
        offsets = np.where(seen, take - model.mean, 0.0)
        own = squares[:, :count, :count].reshape(len(take), -1)
        shared += (seen.T.astype(float) @ own).reshape(shared.shape)
        crossed += offsets.T @ mean[:, :count]
        power += np.sum(offsets**2, axis=0)
        shown += seen.sum(axis=0)
        steps += len(take) - 1
    least = LEAST * np.mean(power) / max(steps, 1)
    transition = np.linalg.solve(before, across[:count].T).T
    drive = (after[:count, :count] - transition @ across[:count].T) / steps
    drive = (drive + drive.T) / 2 + least * np.eye(count)
    loadings = np.linalg.solve(shared, crossed[:, :, None])[:, :, 0]
    explained = np.sum(loadings * crossed, axis=1)
    noise = np.maximum((power - explained) / np.maximum(shown, 1), least)
    return LinearDynamics(model.mean, loadings, transition, drive, noise)
