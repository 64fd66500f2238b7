"""How channels move together: missing ones from those observed, as far as held-out data bears out.

The estimate of missing markers from the others of Liu & McMillan 2006 ("Estimation of missing
markers in human motion capture", section 3), as ridge regression

    min_W  |D_lost - D_seen W|^2 + l |W|^2,

with l for each missing channel that which foretells stretches of time left out best, or no relation
at all where none does.
"""

import numpy as np

# of the mean variance of a channel that is seen
STRENGTHS = np.array([1e-3, 1e-2, 1e-1, 1.0, 10.0])
# less of the variance than this is not worth the risk
LEAST_GAIN = 0.1


def regression(
    rows: np.ndarray, block: np.ndarray, seen: np.ndarray, lost: np.ndarray
) -> np.ndarray:
    """Return how the lost channels follow from those seen.

    Parameters
    ----------
    rows : (N, K) float array, deviations of channels, zero where nothing happens
    block : (N,) int array, the stretch of time that a row is from
    seen, lost : (S,) and (L,) int arrays of channels

    Returns
    -------
    (S, L) float array; a column of zeros where nothing can be told
    """
    given, wanted = rows[:, seen], rows[:, lost]
    errors = np.zeros((len(STRENGTHS), len(lost)))
    numbers = np.unique(block)
    for number in numbers:
        out = block == number
        if out.all():
            break
        made = _solutions(given[~out], wanted[~out])
        errors += [np.sum((wanted[out] - given[out] @ weights) ** 2, axis=0) for weights in made]
    best = np.argmin(errors, axis=0)
    least = errors[best, np.arange(len(lost))]
    told = (least < (1.0 - LEAST_GAIN) * np.sum(wanted**2, axis=0)) & (len(numbers) > 1)
    every = np.stack(_solutions(given, wanted))
    return np.where(told, every[best, :, np.arange(len(lost))].T, 0.0)


def _solutions(given: np.ndarray, wanted: np.ndarray) -> list[np.ndarray]:
    """Return the (S, L) solution of each strength."""
    values, axes = np.linalg.eigh(given.T @ given)
    mean = max(values.mean(), np.finfo(float).tiny)
    turned = axes.T @ (given.T @ wanted)
    return [
        axes @ (turned / (np.maximum(values, 0.0) + strength * mean)[:, None])
        for strength in STRENGTHS
    ]
