"""Motion between two poses, learnt from an actor's takes: what fills the gaps of lost tracking.

What lies between two frames is the straight line and a correction that vanishes at both ends,

    x(u) = (1 - u) x_0 + u x_1 + u (1 - u) sum_k (2 u - 1)^k (f' W_k),   0 < u < 1,

with the features f of the ends (`gap_features`). Its coefficients W_k are those of ridge regression
(Hoerl & Kennard 1970), one set for all channels and each of several durations, from stretches of
the takes that are hidden: sum |x - x(u)|^2 + RIDGE sum_f s_f W_f^2, s_f the sum of squares of a
feature. Between durations they are interpolated. Cubic Hermite interpolation is one choice of W;
the features beyond it tell an actor's move that goes on from one that has come to rest.

Where other channels were observed through the gap, how far these lie off what their own ends
foretell says how far the missing ones do (`channel_relations`); at the ends that is nothing, so
no curve jumps.
"""

import itertools
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from stages.core import channel_relations, gap_features

DURATIONS_S = np.array([2, 4, 6, 11, 16, 24, 31, 46, 61]) / 30
# durations whose deviations tell how channels belong together
RELATED_S = DURATIONS_S[[4, 6]]
TERMS = 3
RIDGE = 0.05
# hidden stretches for each duration: more are more of the same; fewer teach nothing
MOST, FEWEST = 1000, 20
MOST_ROWS = 4000
# numbers that are worked on at once
MOST_CELLS = 1 << 21
SAMPLES = 5
BLOCKS = 6

# take, first frame and length of stretches
Windows = list[tuple[int, int, int]]


class BetweenPoses(NamedTuple):
    """Hold what was learnt of the motion between poses.

    Attributes
    ----------
    durations : (D,) float array, from edge to edge of a gap, ascending [s]
    coefficients : (D, F, TERMS) float array
    deviations : (N, K) float array, of frames from what their gap's ends foretell
    block : (N,) int array, the stretch of time that a row is from
    low, high : (K,) float arrays, the range that the takes have shown
    """

    durations: np.ndarray
    coefficients: np.ndarray
    deviations: np.ndarray
    block: np.ndarray
    low: np.ndarray
    high: np.ndarray


def learn(takes: Sequence[np.ndarray], rates: Sequence[float]) -> BetweenPoses:
    """Learn from takes.

    Parameters
    ----------
    takes : (T, K) float arrays; NaN where not observed
    rates : frames per second of each

    Raises
    ------
    ValueError
        if the takes do not fit each other, or nowhere hold a stretch that can be hidden
    """
    widths = {take.shape[1:] for take in takes}
    if len(widths) != 1 or len(takes) != len(rates):
        shapes = ", ".join(str(take.shape) for take in takes)
        raise ValueError(f"takes {shapes} and {len(rates)} rates do not belong together")
    learnt = {}
    for duration in DURATIONS_S:
        windows = _windows(takes, rates, duration)
        if len(windows) >= FEWEST:
            learnt[duration] = _coefficients(takes, rates, windows)
    if not learnt:
        frames = sum(len(take) for take in takes)
        raise ValueError(f"{frames} frames in {len(takes)} takes hold too few stretches to learn")
    with np.errstate(all="ignore"):
        low = np.nanmin([np.fmin.reduce(take, axis=0) for take in takes], axis=0)
        high = np.nanmax([np.fmax.reduce(take, axis=0) for take in takes], axis=0)
    durations = np.array(list(learnt))
    nothing = np.zeros((0, takes[0].shape[1])), np.zeros(0, int)
    made = BetweenPoses(durations, np.array(list(learnt.values())), *nothing, low, high)
    rows, block = _deviations(made, takes, rates)
    return made._replace(deviations=rows, block=block)


def fill(
    model: BetweenPoses,
    values: np.ndarray,
    rate: float,
    low: np.ndarray | float = -np.inf,
    high: np.ndarray | float = np.inf,
) -> np.ndarray:
    """Fill the gaps of a take; what was observed stays as it is.

    Before the first and after the last frame at which a channel was observed it is held. Elsewhere
    it stays in the range of the takes that were learnt from, or of the gap's own ends.

    Parameters
    ----------
    model : what was learnt, of the same K channels
    values : (T, K) float array; NaN where not observed
    rate : frames per second
    low, high : (K,) float arrays or numbers, limits of what is filled

    Returns
    -------
    (T, K) float array, finite

    Raises
    ------
    ValueError
        if the channels are not those of the model, or one was never observed
    """
    if values.ndim != 2 or values.shape[1] != len(model.low):
        raise ValueError(f"values {values.shape} are not of the {len(model.low)} channels learnt")
    made = np.array(values, float)
    relations: dict[bytes, np.ndarray] = {}
    for (before, after), lost in _gaps(values).items():
        if before < 0 or after >= len(values):
            made[before + 1 : after, lost] = values[after if before < 0 else before, lost]
            continue
        seen = np.isfinite(values[before : after + 1]).all(axis=0)
        known = np.isfinite(values[[before, after]]).all(axis=0)
        found = np.full((after - before - 1, values.shape[1]), np.nan)
        found[:, known] = between(model, values[:, known], before, after, rate)
        inner = found[:, lost]
        if seen.any() and len(model.deviations):
            key = lost.tobytes() + seen.tobytes()
            if key not in relations:
                relations[key] = channel_relations.regression(
                    model.deviations, model.block, np.flatnonzero(seen), lost
                )
            inner = inner + (values[before + 1 : after, seen] - found[:, seen]) @ relations[key]
        ends = values[[before, after]][:, lost]
        inner = np.clip(
            inner,
            np.fmin(model.low[lost], ends.min(axis=0)),
            np.fmax(model.high[lost], ends.max(axis=0)),
        )
        limits = [np.broadcast_to(limit, len(model.low))[lost] for limit in (low, high)]
        made[before + 1 : after, lost] = np.clip(inner, *limits)
    return made


def between(
    model: BetweenPoses, values: np.ndarray, before: int, after: int, rate: float
) -> np.ndarray:
    """Return what the ends of a gap foretell of the frames in it.

    Parameters
    ----------
    model : what was learnt
    values : (T, ..., K) float array, finite in the rows `before` and `after`
    before, after : the edges of the gap
    rate : frames per second

    Returns
    -------
    (after - before - 1, ..., K) float array
    """
    place = np.arange(1, after - before) / (after - before)
    ends = gap_features.features(values, before, after, rate, model.durations[-1])
    bent = np.moveaxis(ends @ _at(model, (after - before) / rate), -1, 0)
    straight = _straight(values[before], values[after], place)
    return straight + np.tensordot(_basis(place), bent, 1)


def _straight(start: np.ndarray, end: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the straight line between two poses at places (L,) in 0..1, (L, ...)."""
    return np.multiply.outer(1.0 - place, start) + np.multiply.outer(place, end)


def _at(model: BetweenPoses, duration: float) -> np.ndarray:
    """Return the coefficients (F, TERMS) of a duration [s]."""
    wanted = np.clip(duration, model.durations[0], model.durations[-1])
    after = np.clip(np.searchsorted(model.durations, wanted), 1, max(len(model.durations) - 1, 1))
    if len(model.durations) == 1:
        return model.coefficients[0]
    start, end = model.durations[after - 1], model.durations[after]
    share = (wanted - start) / (end - start)
    return (1.0 - share) * model.coefficients[after - 1] + share * model.coefficients[after]


def _basis(place: np.ndarray) -> np.ndarray:
    """Return the terms (L, TERMS) of the correction at places (L,) in 0..1."""
    return (place * (1.0 - place))[:, None] * (2.0 * place - 1.0)[:, None] ** np.arange(TERMS)


def _windows(takes: Sequence[np.ndarray], rates: Sequence[float], duration: float) -> Windows:
    """Return stretches to hide, whose frames and those around them are known."""
    found = []
    for number, (take, rate) in enumerate(zip(takes, rates, strict=True)):
        span = max(2, round(duration * rate))
        reach = _reach(rate)
        spoilt = np.concatenate([[0], np.cumsum(~np.isfinite(take).all(axis=1))])
        first = np.arange(reach, len(take) - span - reach)
        clean = first[spoilt[first + span + reach + 1] == spoilt[first - reach]]
        found += [(number, int(start), span) for start in clean]
    chosen = np.unique(np.linspace(0, len(found) - 1, min(MOST, len(found))).astype(int))
    return [found[index] for index in chosen]


def _reach(rate: float) -> int:
    """Return how many frames beyond a gap's edges its features need."""
    return int(np.ceil(gap_features.LAGS * gap_features.STEP_S * rate))


def _blocks(
    takes: Sequence[np.ndarray], rates: Sequence[float], windows: Windows
) -> Iterator[tuple[Windows, np.ndarray, int, int, float]]:
    """Yield windows of one take, their frames (T, N, K), rows of the edges, and the rate."""
    for (number, span), same in itertools.groupby(windows, key=lambda one: (one[0], one[2])):
        take, rate, group = takes[number], rates[number], list(same)
        reach = _reach(rate)
        rows = np.arange(-reach, span + reach + 1)
        size = max(1, MOST_CELLS // (len(rows) * take.shape[1]))
        for first in range(0, len(group), size):
            some = group[first : first + size]
            starts = np.array([start for _, start, _ in some])
            yield some, take[rows[:, None] + starts], reach, reach + span, rate


def _coefficients(
    takes: Sequence[np.ndarray], rates: Sequence[float], windows: Windows
) -> np.ndarray:
    """Return the coefficients (F, TERMS) of the ridge regression over hidden stretches."""
    squares = np.zeros((gap_features.COUNT, gap_features.COUNT))
    products = np.zeros((gap_features.COUNT, TERMS))
    for _, frames, before, after, rate in _blocks(takes, rates, windows):
        place = np.arange(1, after - before) / (after - before)
        bent = frames[before + 1 : after] - _straight(frames[before], frames[after], place)
        terms = np.tensordot(np.linalg.pinv(_basis(place)), bent, 1).reshape(TERMS, -1)
        ends = gap_features.features(frames, before, after, rate)
        ends = ends.reshape(-1, gap_features.COUNT)
        squares += ends.T @ ends
        products += ends.T @ terms.T
    own = np.diag(squares)
    # features that never appear have nothing to say
    kept = squares + RIDGE * np.diag(np.where(own > 0.0, own, 1.0))
    return np.linalg.solve(kept, products)


def _deviations(
    model: BetweenPoses, takes: Sequence[np.ndarray], rates: Sequence[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Return deviations (N, K) of hidden frames from what their ends foretell, and blocks (N,)."""
    rows, times = [np.zeros((0, len(model.low)))], [np.zeros(0)]
    starts = np.concatenate([[0], np.cumsum([len(take) for take in takes])])
    for duration in RELATED_S:
        windows = _windows(takes, rates, duration)
        step = max(1, -(-len(windows) * SAMPLES * len(RELATED_S) // MOST_ROWS))
        for some, frames, before, after, rate in _blocks(takes, rates, windows[::step]):
            inner = np.unique(np.linspace(before, after, SAMPLES + 2)[1:-1].round().astype(int))
            found = between(model, frames, before, after, rate)
            off = frames[inner] - found[inner - before - 1]
            rows.append(off.reshape(-1, off.shape[-1]))
            own = [(starts[number] + start) / starts[-1] for number, start, _ in some]
            times.append(np.tile(own, len(inner)))
    return np.concatenate(rows), (np.concatenate(times) * BLOCKS).astype(int)


def _gaps(values: np.ndarray) -> dict[tuple[int, int], np.ndarray]:
    """Return the channels of every gap by its edges, -1 or T where it has none.

    Raises
    ------
    ValueError
        naming a channel that was never observed
    """
    found: dict[tuple[int, int], list[int]] = {}
    for channel, known in enumerate(np.isfinite(values).T):
        if not known.any():
            raise ValueError(f"channel {channel} of {values.shape} was never observed")
        steps = np.diff(np.concatenate([[True], known, [True]]).astype(int))
        firsts, lasts = np.flatnonzero(steps < 0), np.flatnonzero(steps > 0)
        for first, last in zip(firsts, lasts, strict=True):
            found.setdefault((int(first) - 1, int(last)), []).append(channel)
    return {edges: np.array(channels) for edges, channels in sorted(found.items())}
