"""Fill gaps of markers from the markers around them, and join the ends without a step.

In the head's frame each marker is predicted from the others. What the prediction misses at both
ends of a gap is carried into it by a Gaussian process whose noise, size and time are the marker's
own, so that a short gap follows the marker's path and a long one its neighbours.
"""

from typing import NamedTuple

import numpy as np

from stages.core import marker_statistics

SAMPLE = 4000
LAGS = (1, 2, 4, 8, 16, 32, 64)
TIMES = (2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
# the square of a normal has this median
MEDIAN_SQUARE = 0.4549
AROUND = 24  # frames on either side that a gap is joined to
LEAST = 3  # markers that must be seen
FLOOR_MM = 0.02
UNSURE_MM = 3.0  # deviation beyond which an estimate is worse than none


class Gap(NamedTuple):
    """Hold a run of frames that lack a marker.

    Attributes
    ----------
    marker : index
    first, last : frames, both inside
    """

    marker: int
    first: int
    last: int


class Drift(NamedTuple):
    """Hold how a marker departs from its prediction: `noise + size * matern(lag / time)`.

    Attributes
    ----------
    noise : variance of a frame alone [mm^2]
    size : variance of what lasts [mm^2]
    time : how long it lasts [frames]
    """

    noise: float
    size: float
    time: float


def gaps_of(face: np.ndarray) -> list[Gap]:
    """Return the gaps of points (T, P, 3), by marker and frame."""
    found = []
    for marker in range(face.shape[1]):
        lost = np.isnan(face[:, marker, 0]).astype(np.int8)
        edges = np.flatnonzero(np.diff(np.concatenate([[0], lost, [0]])))
        runs = zip(edges[::2], edges[1::2] - 1, strict=True)
        found += [Gap(marker, int(first), int(last)) for first, last in runs]
    return found


def fill(face: np.ndarray, longest: int) -> np.ndarray:
    """Fill gaps by `E[x_p | others] + E[drift | both ends]`.

    Parameters
    ----------
    face : (T, P, 3) float array [mm] in the head's frame, NaN where not observed
    longest : length of the longest gap that is filled [frames]

    Returns
    -------
    (T, P, 3) array of the same type; NaN is left in longer gaps, on frames with too few markers,
    and where the estimate would be off by more than 3 mm
    """
    chosen = [gap for gap in gaps_of(face) if gap.last - gap.first < longest]
    seen = np.isfinite(face[..., 0])
    chosen = [gap for gap in chosen if seen[:, gap.marker].any()]
    if not chosen:
        return face.copy()
    sample = np.linspace(0, len(face) - 1, min(SAMPLE, len(face))).astype(int)
    model = marker_statistics.fit(face[sample[seen[sample].any(axis=1)]])
    complete = marker_statistics.complete(model, face)
    away = face - marker_statistics.predict_each(model, complete)
    made = face.copy()
    drifts: dict[int, Drift] = {}
    predictors: dict[bytes, np.ndarray] = {}
    for gap in chosen:
        if gap.marker not in drifts:
            # gaps come marker by marker: no other marker needs these matrices again
            drifts[gap.marker], predictors = drift_of(away[:, gap.marker]), {}
        others = _others(seen, gap)
        if len(others) < LEAST:
            continue
        key = others.tobytes()
        if key not in predictors:
            predictors[key] = marker_statistics.predictor(model, gap.marker, others)
        path = _path(face, complete, model.mean, gap, others, predictors[key], drifts[gap.marker])
        if path is not None:
            made[gap.first : gap.last + 1, gap.marker] = path
    return made


def _others(seen: np.ndarray, gap: Gap) -> np.ndarray:
    """Return the markers that are seen in at least half of a gap, on frames that hold any."""
    inside = seen[gap.first : gap.last + 1]
    if (inside.sum(axis=1) < LEAST).any():
        return np.zeros(0, int)
    share = inside.mean(axis=0)
    share[gap.marker] = 0
    return np.flatnonzero(share >= 0.5)


def _path(
    face: np.ndarray,
    complete: np.ndarray,
    mean: np.ndarray,
    gap: Gap,
    others: np.ndarray,
    predictor: np.ndarray,
    drift: Drift,
) -> np.ndarray | None:
    """Return a marker's path through a gap; None if it would be too unsure."""
    start, stop = max(gap.first - AROUND, 0), min(gap.last + 1 + AROUND, len(face))
    offset = (complete[start:stop, others] - mean[others]).reshape(stop - start, -1)
    expected = mean[gap.marker] + offset @ predictor.T
    missed = face[start:stop, gap.marker] - expected
    known = np.isfinite(missed[:, 0])
    frames = np.arange(start, stop)
    inside = (frames >= gap.first) & (frames <= gap.last)
    carried, unsure = bridge(frames[known], missed[known], frames[inside], drift)
    return expected[inside] + carried if unsure <= UNSURE_MM else None


def bridge(
    frames: np.ndarray, values: np.ndarray, wanted: np.ndarray, drift: Drift
) -> tuple[np.ndarray, float]:
    """Return a Gaussian process' values (W, 3) at wanted frames, and its largest deviation.

    Parameters
    ----------
    frames : (N,) int array
    values : (N, 3) float array [mm], zero on average
    wanted : (W,) int array
    drift : its noise, size and time
    """
    size, noise = max(drift.size, FLOOR_MM**2), max(drift.noise, FLOOR_MM**2)
    if not len(frames):
        return np.zeros((len(wanted), 3)), float(np.sqrt(size))
    among = size * _matern((frames[:, None] - frames) / drift.time)
    among[np.diag_indices_from(among)] += noise
    across = size * _matern((wanted[:, None] - frames) / drift.time)
    weights = np.linalg.solve(among, across.T).T
    left = size - (weights * across).sum(axis=1)
    return weights @ values, float(np.sqrt(max(left.max(), 0)))


def drift_of(away: np.ndarray) -> Drift:
    """Fit noise, size and time to how a deviation (T, 3) changes over 1 to 64 frames.

    Minimises `sum_lag (D(lag) - noise - size (1 - matern(lag / time)))^2 / D(lag)^2`, where D is
    half the variance of the change, estimated by medians.
    """
    change = []
    for lag in LAGS:
        squares = (away[lag:] - away[:-lag]) ** 2
        squares = squares[np.isfinite(squares)]
        change.append(np.median(squares) / MEDIAN_SQUARE / 2 if squares.size else np.nan)
    half = np.array(change)
    lags = np.array(LAGS)[np.isfinite(half)]
    half = np.maximum(half[np.isfinite(half)], FLOOR_MM**2)
    if not len(half):
        return Drift(FLOOR_MM**2, 0.0, TIMES[0])
    best, found = np.inf, Drift(float(half[0]), 0.0, TIMES[0])
    for time in TIMES:
        rows = np.stack([np.ones(len(lags)), 1 - _matern(lags / time)], axis=1) / half[:, None]
        noise, size = np.linalg.lstsq(rows, np.ones(len(lags)), rcond=None)[0]
        noise, size = max(noise, 0.0), max(size, 0.0)
        error = ((rows @ [noise, size] - 1) ** 2).sum()
        if error < best:
            best, found = error, Drift(float(noise), float(size), time)
    return found


def _matern(distance: np.ndarray) -> np.ndarray:
    """Return Matern's correlation with smoothness 3/2: paths with a velocity."""
    scaled = np.sqrt(3) * np.abs(distance)
    return (1 + scaled) * np.exp(-scaled)
