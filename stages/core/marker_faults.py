"""Find markers that a capture system has mistaken: jumps, exchanged markers, impossible places.

Each marker is compared with what all the others let expect of it. A fault is a stretch that
begins and ends *suddenly* away from there: the steps of the deviation, not its size, tell a
mistake from a rare expression, which grows over several frames. Only what no face can do is a
fault by its size alone.
"""

from typing import NamedTuple

import numpy as np

from stages.core import marker_statistics, two_state_path

ROUNDS, REFITS = 10, 2
SAMPLE = 4000
# medians and quantiles of the length of a 3-D normal of deviation 1
CHI_50, CHI_90, CHI_99 = 1.538, 2.500, 3.368
STILL_MM = 0.15  # a deviation below which no marker is held to be known
STEP_MM = 0.4  # a fault's steps are held to be at least five of these
USUAL = 10.0  # half the square of a step of 4.5 deviations, which noise alone may reach
CERTAIN = 200.0  # cost of the largest step
SWITCH = 8.0  # cost of a change of state: a sudden step of 6 deviations at either end
TRUSTED = 6.0  # cost at which a deviation speaks for a fault, 3.5 deviations
IMPOSSIBLE_MM, IMPOSSIBLE = 25.0, 10.0  # millimetres and deviations that no face reaches
IMPOSSIBLE_COST = 1.5
FAULT_MM, SMALL = 3.0, 0.3  # nearer than this, a stretch is hardly ever a mistake
UNSEEN = 0.03  # for each frame that a first model is to do without
DOMINANT = 0.7
MOTION = 2.0  # medians of what is taken for motion
SUDDEN_MM = 2.0  # a step that is called a jump
SAME_STRETCH = 0.75
CLOSER = 0.35


class Stretch(NamedTuple):
    """Hold a fault: a marker from its first to its last frame.

    Attributes
    ----------
    marker : index
    first, last : frames, both inside
    partner : the marker that it is exchanged with; -1 for other faults
    sudden : whether it begins or ends with a jump
    """

    marker: int
    first: int
    last: int
    partner: int
    sudden: bool


def find(face: np.ndarray) -> list[Stretch]:
    """Find the stretches where markers are not what they are labelled.

    Minimises, for each marker, `sum_t good_t (d_t + good_{t-1} u_t) + 14 changes`, where `d_t`
    is the doubt of the deviation's size and `u_t` half the square of its sudden step. The worst
    markers of a moment are taken out before the others are judged again without them.

    Parameters
    ----------
    face : (T, P, 3) float array [mm] in the head's frame, NaN where not observed

    Returns
    -------
    list of Stretch, by marker and frame
    """
    known = np.isfinite(face[..., 0])
    bad = _first_doubts(face, known)
    sample = np.linspace(0, len(face) - 1, min(SAMPLE, len(face))).astype(int)
    away, ridge = np.empty_like(face), None
    stale = np.ones(len(face), bool)
    for number in range(ROUNDS):
        if number < REFITS:
            kept = np.where(bad[sample, :, None], np.nan, face[sample])
            model = marker_statistics.fit(kept, ridge)
            ridge = model.ridge
            stale[:] = True
        away[stale] = deviation(model, face[stale], bad[stale])
        doubted, level = _judge(away, known, bad)
        # judged without each other's faults, some turn out to be sound
        worse = (bad & doubted) | _dominant(doubted & ~bad, level)
        stale = (worse != bad).any(axis=1)
        bad = worse
        if not stale.any() and number >= REFITS - 1:
            break
    return _exchanges(face, face - away, _stretches(bad, away))


def _first_doubts(face: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Return cells (T, P) between sudden steps, which a first model is better made without.

    An exchange of two markers that the model has seen is what it expects of them.
    """
    step = _costs(sudden_steps(face), np.zeros_like(known))
    return two_state_path.trace(np.where(known, -UNSEEN, 0), step, SWITCH) & known


def deviation(model: marker_statistics.Gaussian, face: np.ndarray, bad: np.ndarray) -> np.ndarray:
    """Return how far each marker is from what the sound others let expect.

    Parameters
    ----------
    model : the markers' distribution
    face : (T, P, 3) float array [mm], NaN where not observed
    bad : (T, P) bool array, markers that tell nothing of the others

    Returns
    -------
    (T, P, 3) array [mm], NaN where not observed
    """
    away = np.empty_like(face)
    for first in range(0, len(face), marker_statistics.PART):
        part = slice(first, first + marker_statistics.PART)
        trusted = np.where(bad[part, :, None], np.nan, face[part])
        filled = marker_statistics.complete(model, trusted)
        away[part] = face[part] - marker_statistics.predict_each(model, filled)
    return away


def _judge(away: np.ndarray, known: np.ndarray, bad: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which cells are doubted, and how many deviations each is away."""
    distance = np.linalg.norm(away, axis=2)
    sound = np.where(bad, np.nan, distance)
    half, most = _quantiles(sound, (0.5, 0.9))
    size = np.maximum(np.maximum(half / CHI_50, most / CHI_90), STILL_MM)
    level = np.where(known, distance / size, 0).astype(np.float32)
    limit = np.maximum(IMPOSSIBLE * size, IMPOSSIBLE_MM)
    doubt = np.minimum(level**2 / 2, TRUSTED) - TRUSTED
    doubt += IMPOSSIBLE_COST * (distance > limit) - SMALL * (distance < FAULT_MM)
    doubt = np.where(known, doubt, 0)
    step = _costs(sudden_steps(away), bad)
    return two_state_path.trace(doubt, step, SWITCH) & known, level


def _costs(steps: np.ndarray, bad: np.ndarray) -> np.ndarray:
    """Return half the squares of steps (T, P) in units of each marker's own, less the usual."""
    (scale,) = _quantiles(np.where(bad, np.nan, steps), (0.99,))
    half_squares = np.nan_to_num(steps / np.maximum(scale / CHI_99, STEP_MM)) ** 2 / 2
    return np.clip(half_squares - USUAL, 0, CERTAIN)


def _quantiles(values: np.ndarray, shares: tuple[float, ...]) -> np.ndarray:
    """Return quantiles of each column; 0 for a column without values."""
    seen = np.isfinite(values).any(axis=0)
    found = np.zeros((len(shares), values.shape[1]))
    found[:, seen] = np.nanquantile(values[:, seen], shares, axis=0)
    return found


def sudden_steps(away: np.ndarray) -> np.ndarray:
    """Return how far each frame is from the one before, less the motion around the step.

    The motion around is the median of the two steps before and the two after. After a gap the
    step is counted from the last observed frame, and divided by the root of the frames between.

    Parameters
    ----------
    away : (T, P, 3) float array [mm], NaN where not observed

    Returns
    -------
    (T, P) float array [mm]; NaN where not observed, 0 on the first observed frame
    """
    return np.stack([_sudden_steps_of(away[:, p]) for p in range(away.shape[1])], axis=1)


def _sudden_steps_of(away: np.ndarray) -> np.ndarray:
    """Return the sudden steps (T,) of one marker (T, 3)."""
    count = len(away)
    step = np.full((count + 4, 3), np.nan, away.dtype)
    step[3 : count + 2] = np.diff(away, axis=0)
    around = np.stack([step[shift : shift + count] for shift in (0, 1, 3, 4)])
    around.sort(axis=0)  # NaN last
    motion = np.where(np.isnan(around[3]), 0, (around[1] + around[2]) / 2)
    speed = np.linalg.norm(motion, axis=1, keepdims=True)
    # motion that may be noise only adds its own
    noise = MOTION * np.median(speed[speed > 0]) if (speed > 0).any() else 0.0
    motion *= np.maximum(speed - noise, 0) / np.where(speed > 0, speed, 1)
    sudden = np.linalg.norm(step[2 : count + 2] - motion, axis=1)
    seen = np.flatnonzero(np.isfinite(away[:, 0]))
    sudden[seen[:1]] = 0
    after = seen[1:][np.diff(seen) > 1]
    before = seen[:-1][np.diff(seen) > 1]
    apart = np.linalg.norm(away[after] - away[before], axis=1)
    sudden[after] = apart / np.sqrt(after - before)
    return sudden


def _dominant(fresh: np.ndarray, level: np.ndarray) -> np.ndarray:
    """Return those of the new cells that no other marker of their frame explains better."""
    worst = np.where(fresh, level, 0).max(axis=1, keepdims=True)
    strong = fresh & (level >= DOMINANT * worst)
    chosen = np.zeros_like(fresh)
    for marker in np.flatnonzero(strong.any(axis=0)):
        for first, last in _runs(fresh[:, marker]):
            if strong[first : last + 1, marker].mean() > 0.5:
                chosen[first : last + 1, marker] = True
    return chosen


def _runs(flags: np.ndarray) -> list[tuple[int, int]]:
    """Return first and last index of every run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(np.int8), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _stretches(bad: np.ndarray, away: np.ndarray) -> list[Stretch]:
    """Return the runs of bad cells, by marker and frame."""
    steps = sudden_steps(away)
    found = []
    for marker in np.flatnonzero(bad.any(axis=0)):
        for first, last in _runs(bad[:, marker]):
            ends = steps[[first, min(last + 1, len(steps) - 1)], marker]
            sudden = bool(np.nanmax(np.append(ends, 0)) > SUDDEN_MM)
            found.append(Stretch(int(marker), first, last, -1, sudden))
    return found


def _exchanges(face: np.ndarray, expected: np.ndarray, stretches: list[Stretch]) -> list[Stretch]:
    """Name the partner of markers that have exchanged their labels.

    Two markers are exchanged where each is far nearer to the other's expected place than to its
    own, over a stretch that both share; both then get the union of their stretches.
    """
    found = sorted(stretches, key=lambda stretch: (stretch.first, stretch.marker))
    for one in range(len(found)):
        for other in range(one + 1, len(found)):
            p, q = found[one], found[other]
            if q.first > p.last or p.partner >= 0:
                break
            both = min(p.last, q.last) - q.first + 1
            first, last = p.first, max(p.last, q.last)
            if q.partner >= 0 or both < SAME_STRETCH * (last - first + 1):
                continue
            if _nearer(face, expected, (p.marker, q.marker), slice(first, last + 1)):
                found[one] = Stretch(p.marker, first, last, q.marker, True)
                found[other] = Stretch(q.marker, first, last, p.marker, True)
    return sorted(found)


def _nearer(face: np.ndarray, expected: np.ndarray, pair: tuple[int, int], frames: slice) -> bool:
    """Return whether each of two markers is where the other is expected."""
    for here, there in (pair, pair[::-1]):
        own = np.linalg.norm(face[frames, here] - expected[frames, here], axis=1)
        others = np.linalg.norm(face[frames, here] - expected[frames, there], axis=1)
        known = np.isfinite(own) & np.isfinite(others)
        if not known.any() or np.median(others[known]) > CLOSER * np.median(own[known]):
            return False
    return True
