"""Whether mouthClose closes the lips under an open jaw, which is what trackers mean by it."""

import numpy as np

FULL = 0.15  # so much of jawOpen in mouthClose, by projection; on clean rigs -0.1 and -0.6
CLOSES = (0.5, 2.5)  # share of the opening that it takes back; on clean rigs 1.0 and 1.4
LOW, HIGH = 0.5, 0.25  # of the largest opening: more for lower lips, less for upper ones
REACH = 0.1  # face units between lips that touch
FEWEST, MOST = 3, 2000


def fault(
    neutral: np.ndarray, jaw: np.ndarray, close: np.ndarray, face_unit: float
) -> tuple[str, str] | None:
    """Find a mouthClose that opens the jaw itself, or that does not close an open mouth.

    Parameters
    ----------
    neutral : (V, 3) float array
    jaw, close : (V, 3) float arrays, jawOpen and mouthClose less the neutral
    face_unit : [the unit of all]

    Returns
    -------
    (what was found, cure), or None, also where no lips can be made out
    """
    if not jaw.any() or not close.any():
        return None
    share = float((jaw * close).sum() / (jaw * jaw).sum())
    if share > FULL:
        found = f"holds {share:.0%} of jawOpen itself: it is a whole pose, of jaw and lips"
        return found, "subtract jawOpen from it: trackers send mouthClose on top of jawOpen"
    lower, upper = lip_pairs(neutral, jaw, face_unit)
    if len(lower) < FEWEST:
        return None
    found = _closing_fault(jaw, close, lower, upper)
    cure = "it should be what jawOpen lacks to closed lips: multiply its curve, or leave it out"
    return (found, cure) if found else None


def _closing_fault(
    jaw: np.ndarray, close: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> str | None:
    """Return what is wrong with how pairs of lips (n,) close under an open jaw."""
    moved = np.linalg.norm(close, axis=1)
    used = np.maximum(moved[lower], moved[upper]) > moved.max() / 10
    if not used.any():
        return "moves none of the lips that jawOpen opens"
    lower, upper = lower[used], upper[used]
    opening = jaw[lower] - jaw[upper]
    back = -((close[lower] - close[upper]) * opening).sum(axis=1) / (opening**2).sum(axis=1)
    closed = float(np.median(back))
    if closed < CLOSES[0]:
        return f"takes back {closed:.0%} of the lips' opening under jawOpen, not all"
    if closed > CLOSES[1]:
        return f"takes back {closed:.0%} of the lips' opening: they pass through each other"
    return None


def lip_pairs(
    neutral: np.ndarray, jaw: np.ndarray, face_unit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (n,) that touch in the neutral and that jawOpen parts: lower, upper."""
    opened = np.linalg.norm(jaw, axis=1)
    lower = np.flatnonzero(opened > LOW * opened.max())
    lower = lower[:: -(-len(lower) // MOST)]
    reach = REACH * face_unit
    low, high = neutral[lower].min(axis=0) - reach, neutral[lower].max(axis=0) + reach
    near = ((neutral >= low) & (neutral <= high)).all(axis=1)
    upper = np.flatnonzero(near & (opened < HIGH * opened.max()))
    if not len(upper):
        return lower[:0], upper
    pairs = []
    for vertex in lower:
        squares = ((neutral[upper] - neutral[vertex]) ** 2).sum(axis=1)
        closest = int(np.argmin(squares))
        if squares[closest] < reach**2:
            pairs.append((vertex, upper[closest]))
    found = np.array(pairs, int).reshape(-1, 2)
    return found[:, 0], found[:, 1]
