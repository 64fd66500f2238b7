"""Expected states of a linear dynamical system: Kalman filter and smoother.

    s_t = F s_t-1 + w,  w ~ N(0, Q);   x_t = C s_t[:C] + v,  v ~ N(0, diag R)

Kalman 1960; Rauch et al. 1965, as in Shumway & Stoffer 1982, appendix A. The filter is
in information form, so that curves which were not observed are left out. Covariances depend on what
was observed alone: once they have settled they are kept, and a long take costs little.
"""

from typing import NamedTuple

import numpy as np

# relative change of a covariance below which it has settled
SETTLED = 1e-10


class System(NamedTuple):
    """Hold a system of N states, of which the first C show in K curves.

    Attributes
    ----------
    transition : (N, N) float array, F
    drive : (N, N) float array, Q, positive definite
    loadings : (K, C) float array
    noise : (K,) float array, R, above zero
    """

    transition: np.ndarray
    drive: np.ndarray
    loadings: np.ndarray
    noise: np.ndarray


class Expected(NamedTuple):
    """Hold the expected states of T frames, given all that was observed.

    Attributes
    ----------
    mean : (T, N) float array
    covariance : T times an (N, N) float array
    gain : T - 1 times an (N, N) float array, of the smoother from a frame to the one before
    """

    mean: np.ndarray
    covariance: list[np.ndarray]
    gain: list[np.ndarray]


def smooth(system: System, offsets: np.ndarray) -> Expected:
    """Return the expected states.

    Before the first frame the states are spread as widely as the system spreads them in a second
    or so, about zero.

    Parameters
    ----------
    system : the system
    offsets : (T, K) float array, curves less their mean; NaN where not observed
    """
    ahead, predicted, filtered, means = _filter(system, offsets)
    mean, covariance = means.copy(), [filtered[-1]]
    gains: list[np.ndarray] = []
    for t in range(len(means) - 2, -1, -1):
        same = t + 2 < len(means) and filtered[t] is filtered[t + 1]
        same = same and predicted[t + 1] is predicted[t + 2]
        if not same:
            gain = np.linalg.solve(predicted[t + 1], system.transition @ filtered[t]).T
        mean[t] += gain @ (mean[t + 1] - ahead[t + 1])
        last = covariance[-1]
        settled = same and len(covariance) > 1 and last is covariance[-2]
        if not settled:
            spread = filtered[t] + gain @ (last - predicted[t + 1]) @ gain.T
            last = last if same and _close(spread, last) else spread
        covariance.append(last)
        gains.append(gain)
    return Expected(mean, covariance[::-1], gains[::-1])


def _filter(
    system: System, offsets: np.ndarray
) -> tuple[np.ndarray, list[np.ndarray], list[np.ndarray], np.ndarray]:
    """Return predicted means (T, N) and covariances, filtered covariances and means (T, N)."""
    count, shown = system.loadings.shape[1], np.isfinite(offsets)
    values = np.where(shown, offsets, 0.0)
    size = len(system.transition)
    mean, spread = np.zeros(size), _spread(system)
    ahead, means = np.empty((len(offsets), size)), np.empty((len(offsets), size))
    predicted: list[np.ndarray] = []
    filtered: list[np.ndarray] = []
    for t, seen in enumerate(shown):
        if t:
            mean = system.transition @ mean
            spread = system.transition @ filtered[-1] @ system.transition.T + system.drive
        repeated = t > 0 and np.array_equal(seen, shown[t - 1])
        if repeated and (spread is predicted[-1] or _close(spread, predicted[-1])):
            spread, after = predicted[-1], filtered[-1]
        else:
            weighed = system.loadings.T * (seen / system.noise)
            after = _updated(spread, weighed @ system.loadings)
            gain = after[:, :count] @ weighed
        ahead[t] = mean
        mean = mean + gain @ (values[t] - system.loadings @ mean[:count])
        means[t] = mean
        predicted.append(spread)
        filtered.append(after)
    return ahead, predicted, filtered, means


def _updated(spread: np.ndarray, information: np.ndarray) -> np.ndarray:
    """Return a covariance (N, N) after frames told the first states (C, C) of information."""
    count = len(information)
    left = np.eye(len(spread))
    left[:, :count] += spread[:, :count] @ information
    after = np.linalg.solve(left, spread)
    return (after + after.T) / 2


def _spread(system: System) -> np.ndarray:
    """Return how widely the states are spread before the first frame (N, N).

    The covariance after 2^5 steps by doubling: a stable system has come to rest by then, another
    has not yet run away.
    """
    spread, step = system.drive, system.transition
    for _ in range(5):
        spread = spread + step @ spread @ step.T
        step = step @ step
    return spread


def _close(one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two covariances are the same for all that follows."""
    return bool(np.abs(one - other).max() <= SETTLED * np.abs(other).max())
