"""Ways to fill a gap in curves, to be compared with what the project learns: `dynamics_trial`.

A filler takes a stretch (T, K) of curves, NaN where they are lost, and returns it whole.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy.interpolate

from bench import linear_dynamics
from stages.core import between_poses, pca

Filler = Callable[[np.ndarray], np.ndarray]
# settings that were best where nothing is tested: learnt from the first two fifths of the track and
# tried on the third
COMPONENTS, CONTEXT, NUGGET = 20, 8, 1e-4
RIDGE_COMPONENTS, RIDGE_CONTEXT, RIDGE = 15, 8, 0.1
NEAREST, NEAREST_CONTEXT = 20, 4


class Gap(NamedTuple):
    """Hold where a stretch is lost: rows from `first` to before `end`, channels `lost` (K,)."""

    first: int
    end: int
    lost: np.ndarray


def gap_of(values: np.ndarray) -> Gap:
    """Return the one gap of a stretch."""
    missing = np.isnan(values)
    rows = np.flatnonzero(missing.any(axis=1))
    return Gap(rows[0], rows[-1] + 1, missing.any(axis=0))


def linear(values: np.ndarray) -> np.ndarray:
    """Fill along straight lines."""
    gap = gap_of(values)
    inner = straight(values, gap.first - 1, gap.end)
    return _put(values, gap, inner[:, gap.lost])


def straight(values: np.ndarray, before: int, after: int) -> np.ndarray:
    """Return the straight line between two rows, without them."""
    place = np.arange(1, after - before)[:, None] / (after - before)
    return (1 - place) * values[before] + place * values[after]


def hermite(values: np.ndarray) -> np.ndarray:
    """Fill by cubic Hermite interpolation, with the slopes of the last frame on each side."""
    gap = gap_of(values)
    rows = [gap.first - 1, gap.end]
    slopes = np.stack(
        [values[rows[0]] - values[rows[0] - 1], values[rows[1] + 1] - values[rows[1]]]
    )
    curve = scipy.interpolate.CubicHermiteSpline(rows, values[rows], slopes)
    return _put(values, gap, curve(np.arange(gap.first, gap.end))[:, gap.lost])


def monotone(values: np.ndarray) -> np.ndarray:
    """Fill by the monotone cubic of Fritsch & Carlson, through four frames on each side."""
    return _interpolated(values, scipy.interpolate.PchipInterpolator, 4)


def spline(values: np.ndarray) -> np.ndarray:
    """Fill by the cubic spline through two frames on each side."""
    return _interpolated(values, scipy.interpolate.CubicSpline, 2)


def _interpolated(values, kind, reach):
    """Fill by a curve through some frames on each side."""
    gap = gap_of(values)
    rows = np.r_[gap.first - reach : gap.first, gap.end : gap.end + reach]
    made = kind(rows, values[rows][:, gap.lost])(np.arange(gap.first, gap.end))
    return _put(values, gap, made)


def _put(values, gap, inner):
    """Return a stretch with its gap filled."""
    made = values.copy()
    made[gap.first : gap.end, gap.lost] = inner
    return made


def system(takes: list[np.ndarray]) -> Filler:
    """Learn a linear dynamical system by EM (Shumway & Stoffer 1982; DynaMMo)."""
    model = linear_dynamics.learn(takes)
    return lambda values: linear_dynamics.fill(model, values)


def learnt(takes: list[np.ndarray], rates: list[float], rate: float) -> Filler:
    """Learn the project's own motion between poses."""
    model = between_poses.learn(takes, rates)
    return lambda values: between_poses.fill(model, values, rate)


def kriging(takes: list[np.ndarray]) -> Filler:
    """Learn a Gaussian process for each principal component, its covariance from the takes."""
    axes = pca.fit(np.concatenate(takes))
    scores = [(take - axes.mean) @ axes.components[:COMPONENTS].T for take in takes]
    reach = min(120, *(len(one) for one in scores))
    covariance = np.stack(
        [
            sum((one[: len(one) - lag] * one[lag:]).sum(axis=0) for one in scores)
            for lag in range(reach)
        ]
    ) / sum(map(len, scores))

    def fill(values):
        gap = gap_of(values)
        rows = np.r_[gap.first - CONTEXT : gap.first, gap.end : gap.end + CONTEXT]
        inner = np.arange(gap.first, gap.end)
        made, ones = [], np.ones(len(rows))
        for component, axis in zip(covariance.T, axes.components[:COMPONENTS], strict=True):
            own = component[np.abs(rows[:, None] - rows)] + NUGGET * component[0] * np.eye(
                len(rows)
            )
            weights = np.linalg.solve(own, component[np.abs(rows[:, None] - inner)]).T
            even = np.linalg.solve(own, ones)
            # the mean is not known: weights sum to one
            weights = weights + np.outer(1 - weights.sum(axis=1), even / even.sum())
            made.append(weights @ ((values[rows] - axes.mean) @ axis))
        kept = axes.components[:COMPONENTS]
        rest = values - axes.mean - (values - axes.mean) @ kept.T @ kept
        inner = axes.mean + np.stack(made, axis=1) @ kept
        inner = inner + straight(rest, gap.first - 1, gap.end)
        return _put(values, gap, inner[:, gap.lost])

    return fill


def _windows(takes, length, reach):
    """Yield a take and the edges of every gap that could be in it."""
    for take in takes:
        for before in range(reach, len(take) - length - 1 - reach):
            yield take, before, before + length + 1


def ridge(takes: list[np.ndarray]) -> Filler:
    """Learn ridge regressions of the gap's frames from frames on both sides, for each length."""
    axes = pca.fit(np.concatenate(takes))
    kept = axes.components[:RIDGE_COMPONENTS]
    scores = [(take - axes.mean) @ kept.T for take in takes]
    known = {}

    def features(values, before, after):
        start, end = values[before], values[after]
        left = values[before - RIDGE_CONTEXT + 1 : before] - start
        right = values[after + 1 : after + RIDGE_CONTEXT] - end
        return np.concatenate([left.ravel(), right.ravel(), end - start, start + end])

    def fill(values):
        gap = gap_of(values)
        length = gap.end - gap.first
        if length not in known:
            stretches = list(_windows(scores, length, RIDGE_CONTEXT))
            given = np.stack([features(*one) for one in stretches])
            wanted = np.stack([_bent(*one).ravel() for one in stretches])
            squares = given.T @ given
            squares += RIDGE * np.trace(squares) / len(squares) * np.eye(len(squares))
            known[length] = np.linalg.solve(squares, given.T @ wanted)
        own = features((values - axes.mean) @ kept.T, gap.first - 1, gap.end)
        bent = (own @ known[length]).reshape(length, -1) @ kept
        inner = straight(values, gap.first - 1, gap.end) + bent
        return _put(values, gap, inner[:, gap.lost])

    return fill


def _bent(values, before, after):
    """Return how far frames lie off the straight line."""
    return values[before + 1 : after] - straight(values, before, after)


def nearest(takes: list[np.ndarray]) -> Filler:
    """Take over what the most similar stretches of the takes do, off their straight lines."""
    axes = pca.fit(np.concatenate(takes))
    kept = axes.components[:RIDGE_COMPONENTS]
    scores = [(take - axes.mean) @ kept.T for take in takes]
    known = {}

    def features(values, before, after):
        pace = 15 / NEAREST_CONTEXT
        left = pace * (values[before] - values[before - NEAREST_CONTEXT])
        right = pace * (values[after + NEAREST_CONTEXT] - values[after])
        return np.concatenate([values[before], values[after], left, right])

    def fill(values):
        gap = gap_of(values)
        length = gap.end - gap.first
        if length not in known:
            stretches = list(_windows(takes, length, NEAREST_CONTEXT))
            turned = _windows(scores, length, NEAREST_CONTEXT)
            known[length] = stretches, np.stack([features(*one) for one in turned])
        stretches, seen = known[length]
        own = features((values - axes.mean) @ kept.T, gap.first - 1, gap.end)
        distance = np.sum((seen - own) ** 2, axis=1)
        chosen = np.argsort(distance)[:NEAREST]
        weights = np.exp(-distance[chosen] / (2 * distance[chosen[-1]] + 1e-12))
        weights /= weights.sum()
        bent = sum(w * _bent(*stretches[row]) for w, row in zip(weights, chosen, strict=True))
        inner = straight(values, gap.first - 1, gap.end) + bent
        return _put(values, gap, inner[:, gap.lost])

    return fill
