"""How many key shapes a region needs, from its held-out errors."""

import numpy as np


def within_budget(counts, errors, budget):
    """Return the smallest count whose error is within the budget, and why in plain words.

    Parameters
    ----------
    counts : sequence of int, ascending
    errors : sequence of float [face units]
        Held-out error of each count.
    budget : float [face units]

    Raises
    ------
    ValueError
        When there is no count, or the lists differ in length.
    """
    counts, errors = _checked(counts, errors)
    enough = np.flatnonzero(errors <= budget)
    if len(enough):
        best = enough[0]
        return int(counts[best]), (
            f"fewest whose held-out error, {errors[best]:.4f} face units, "
            f"is within the budget of {budget:g}"
        )
    best = errors.argmin()
    return int(counts[best]), (
        f"no count tried is within the budget of {budget:g} face units; "
        f"this one comes nearest with {errors[best]:.4f}"
    )


def at_knee(counts, errors):
    """Return the count farthest below the line between the ends of the error curve, and why.

    Both axes are scaled to 0..1, so the answer has no unit (Satopaa et al. 2011).

    Parameters
    ----------
    counts : sequence of int, ascending
    errors : sequence of float [face units]
        Held-out error of each count.

    Raises
    ------
    ValueError
        When there is no count, or the lists differ in length.
    """
    counts, errors = _checked(counts, errors)
    # what more shapes cannot spoil: a held-out curve may rise again
    lowest = np.minimum.accumulate(errors)
    across = (counts - counts[0]) / max(counts[-1] - counts[0], 1)
    down = (lowest[0] - lowest) / max(lowest[0] - lowest[-1], np.finfo(float).tiny)
    best = (down - across).argmax()
    return int(counts[best]), (
        f"knee of the held-out error: {errors[best]:.4f} face units here, "
        f"{errors[0]:.4f} with {counts[0]} and {errors[-1]:.4f} with {counts[-1]}"
    )


def _checked(counts, errors):
    """Return both lists as arrays of equal length."""
    counts, errors = np.asarray(counts), np.asarray(errors, float)
    if counts.shape != errors.shape or not len(counts):
        raise ValueError(f"counts {counts.shape} and errors {errors.shape} do not fit")
    return counts, errors
