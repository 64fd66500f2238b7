"""What can be wrong with one sculpt, found by measuring it against the neutral and the others."""

import numpy as np

# ratios of sizes that a forgotten unit gives: metric, inch to cm and mm, foot to cm and m
UNIT_RATIOS = (10.0, 100.0, 1000.0, 2.54, 25.4, 30.48, 3.28)
UNIT_TOLERANCE = 0.15
SIZE_LIMIT = 1.6
SAME = 1e-6
# a shift of the whole: so far (share of the size), and three in four vertices so much alike
SHIFT_LIMIT = 0.01
SHIFT_PART = 0.75
SHIFT_SPREAD = 0.25
# another axis up: so far off, and turning it back leaves so little of that
TURN_LIMIT = 0.1
TURN_REST = 0.25
SWAPPED_AXES = (
    np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
)


def diagonal(points: np.ndarray) -> float:
    """Return the diagonal of the bounding box of (V, D) points."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def placement_fault(sculpt: np.ndarray, neutral: np.ndarray) -> tuple[str, str] | None:
    """Find a sculpt in another unit, with another axis up, or moved as a whole.

    Parameters
    ----------
    sculpt, neutral : (V, 3) float arrays

    Returns
    -------
    (what was found, cure), or None
    """
    size = diagonal(neutral)
    if not size > 0:
        return None
    ratio = diagonal(sculpt) / size
    for factor in UNIT_RATIOS:
        for tried, word in ((factor, "larger"), (1 / factor, "smaller")):
            if abs(ratio / tried - 1) < UNIT_TOLERANCE:
                found = f"about {factor:g} times {word} than the neutral"
                return found, "export it in the neutral's unit"
    if not 1 / SIZE_LIMIT < ratio < SIZE_LIMIT:
        found = f"its bounding box is {ratio:.3g} times the neutral's"
        return found, "export it without scaling, or check that it is this character's"
    moved = sculpt - neutral
    off = np.linalg.norm(moved)
    if off > TURN_LIMIT * np.linalg.norm(neutral) and any(
        np.linalg.norm(sculpt @ turn.T - neutral) < TURN_REST * off for turn in SWAPPED_AXES
    ):
        return "another axis points up than in the neutral", "export it with the same up axis"
    shift = np.median(moved, axis=0)
    length = np.linalg.norm(shift)
    spread = np.quantile(np.linalg.norm(moved - shift, axis=1), SHIFT_PART)
    if length > SHIFT_LIMIT * size and spread < SHIFT_SPREAD * length:
        found = f"moved as a whole by {' '.join(f'{value:.3g}' for value in shift)}"
        return found, "put it back where the neutral stands, without head motion"
    return None


def equal(first: np.ndarray, second: np.ndarray, size: float) -> bool:
    """Tell whether two poses are the same within a millionth of the character's size."""
    return bool(np.abs(first - second).max() <= SAME * size)
