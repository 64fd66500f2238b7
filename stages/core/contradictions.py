"""Sculpts that contradict the actor, found by comparing key shapes in the source and the target.

CB02, section 5: if the mouth opens wider in one key shape than in another, the artist's must too,
or the output jitters. Characters differ from actors, so only reversals count: two sculpts that
fit far better when exchanged, and the order of two extremes of the same kind turned round.
"""

import itertools

import numpy as np

# relative error that a sculpt may have, as in the tolerant solve of weights
SCULPT_ERROR = 0.15
# exchanged sculpts: at least so much better, and so far apart in the source (share of the median)
EXCHANGE_GAIN = 0.45
MIN_DISTANCE = 0.5
# extremes of the same kind: so parallel in the source, so much farther there, so much nearer here
PARALLEL = 0.95
FARTHER = 1.5
NEARER = 1.25


def by_range(offsets: np.ndarray) -> np.ndarray:
    """Measure each coordinate by its greatest offset: controls may be degrees or centimetres.

    Parameters
    ----------
    offsets : (K, N) float array, differences from the neutral

    Returns
    -------
    (K, N) float array in -1..1
    """
    extent = np.abs(offsets).max(axis=0)
    return offsets / np.where(extent > 0, extent, 1.0)


def _distances(products: np.ndarray) -> np.ndarray:
    """Return the (K + 1, K + 1) distances among the neutral (first) and shapes of a Gram matrix."""
    padded = np.pad(products, ((1, 0), (1, 0)))
    square = np.diag(padded)
    return np.sqrt(np.maximum(square[:, None] + square[None, :] - 2 * padded, 0.0))


def exchange_score(source: np.ndarray, target: np.ndarray, first: int, second: int) -> float:
    """Say how much better two sculpts would fit if they were exchanged.

    The two are predicted from the others, with the weights that describe them in the source,
    `w = argmin |s_i - sum w_k s_k|^2 + sigma^2 sum w_k^2 |s_k|^2`; `E` is the summed squared
    distance of the predictions from the sculpts as they are, `E'` exchanged.

    Parameters
    ----------
    source, target : (K, K) float arrays, Gram matrices
    first, second : the two

    Returns
    -------
    (E' - E) / (E' + E), in -1..1; negative where exchanging them fits better
    """
    rest = [k for k in range(len(source)) if k not in (first, second)]
    if not rest:
        return 0.0
    system = source[np.ix_(rest, rest)]
    system = system + SCULPT_ERROR**2 * np.diag(np.diag(system))

    def miss(shape: int, sculpt: int) -> float:
        weights = np.linalg.lstsq(system, source[rest, shape], rcond=None)[0]
        predicted = weights @ target[np.ix_(rest, rest)] @ weights
        return predicted - 2 * weights @ target[rest, sculpt] + target[sculpt, sculpt]

    kept = miss(first, first) + miss(second, second)
    exchanged = miss(first, second) + miss(second, first)
    return float((exchanged - kept) / max(exchanged + kept, np.finfo(float).tiny))


def exchanged_pairs(source: np.ndarray, target: np.ndarray) -> list[tuple[int, int]]:
    """Find pairs of sculpts that fit the actor only when exchanged.

    Both must speak against the pair: the prediction of `exchange_score`, and the order of the two
    shapes' distances from the neutral and all others, source against target. The worst pair is
    set aside before the next is looked for.

    Parameters
    ----------
    source, target : (K, K) float arrays, Gram matrices

    Returns
    -------
    pairs of rows, worst first
    """
    left = list(range(len(source)))
    found = []
    while len(left) > 2:
        inner_source, inner_target = source[np.ix_(left, left)], target[np.ix_(left, left)]
        near, sculpted = _distances(inner_source), _distances(inner_target)
        scores = {}
        for i, j in itertools.combinations(range(len(left)), 2):
            others = [k for k in range(len(near)) if k not in (i + 1, j + 1)]
            order = (near[i + 1] - near[j + 1]) * (sculpted[i + 1] - sculpted[j + 1])
            apart = near[i + 1, j + 1] > MIN_DISTANCE * np.median(near)
            if apart and order[others].sum() < 0:
                scores[i, j] = exchange_score(inner_source, inner_target, i, j)
        worst = min(scores, key=scores.get, default=None)
        if worst is None or scores[worst] > -EXCHANGE_GAIN:
            return found
        found.append((left[worst[0]], left[worst[1]]))
        left = [row for k, row in enumerate(left) if k not in worst]
    return found


def reversed_extremes(source: np.ndarray, target: np.ndarray) -> list[tuple[int, int]]:
    """Find pairs of the same kind of shape whose sculpts are in the other order.

    Parameters
    ----------
    source, target : (K, K) float arrays, Gram matrices

    Returns
    -------
    (i, j): i goes clearly farther than j from the neutral in the source and less in the target
    """
    length, sculpted = np.sqrt(np.diag(source)), np.sqrt(np.diag(target))
    floor = np.finfo(float).tiny
    cosine = source / np.maximum(np.outer(length, length), floor)
    return [
        (i, j)
        for i, j in itertools.permutations(range(len(source)), 2)
        if cosine[i, j] > PARALLEL
        and length[i] > FARTHER * length[j]
        and sculpted[j] > NEARER * sculpted[i]
    ]
