"""Keys of a curve by Ramer, Douglas and Peucker: the farthest point, and again on both sides."""

import numpy as np


def keys(values: np.ndarray, tolerance: float) -> np.ndarray:
    """Return the rows (N,) that stay, so that lines between them keep to a curve.

    Distances are vertical, since the values are a function of the frame.

    Parameters
    ----------
    values : (T,) float array
    tolerance : largest difference of a row [unit of the values]

    Raises
    ------
    ValueError
        if there is no value, or the tolerance is negative
    """
    if np.ndim(values) != 1 or not len(values) or not tolerance >= 0:
        raise ValueError(f"cannot keep values {np.shape(values)} within {tolerance}")
    last = len(values) - 1
    kept, open_spans = {0, last}, [(0, last)]
    while open_spans:
        low, high = open_spans.pop()
        inside = np.arange(low + 1, high)
        if not len(inside):
            continue
        slope = (values[high] - values[low]) / (high - low)
        away = np.abs(values[inside] - values[low] - slope * (inside - low))
        worst = int(away.argmax())
        if away[worst] > tolerance:
            middle = low + 1 + worst
            kept.add(middle)
            open_spans += [(low, middle), (middle, high)]
    return np.array(sorted(kept))
