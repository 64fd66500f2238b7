"""How far tuned examples reach over a performance, and which frames to tune next.

The leverage of a frame says how much a linear map from the examples would have to reach out for it:
``h(x) = z' (sum_n z_n z_n' + ridge I)^-1 z``, where ``z = (1, (x - m) / s)``, `m` is the mean of
the frames and `s` their root mean square distance from it. One leverage is the variance of such a
map's prediction there, in units of the animator's own. D06 section 8 asks for such a measure.
"""

import numpy as np

RIDGE = 1e-3


def leverage(examples, frames, ridge=RIDGE):
    """Return how far each frame lies outside what the examples span.

    Parameters
    ----------
    examples : (N, C) float array
        Coordinates of the tuned frames on principal axes; N may be 0.
    frames : (T, C) float array
    ridge : float
        Keeps directions that no example shows at a finite leverage, up to ``|z|^2 / ridge``.

    Returns
    -------
    (T,) float array

    Raises
    ------
    ValueError
        When the numbers of coordinates differ, or the ridge is not positive.
    """
    lifted_examples, lifted = _lift(examples, frames, ridge)
    return _leverage(_inverse(lifted_examples, ridge), lifted)


def uncovered_share(examples, frames, ridge=RIDGE):
    """Return the share of frames outside the examples, 0..1; one where there are none.

    A frame is outside when its leverage is above that of every example (the hull of Cook 1977):
    outside the smallest ellipsoid, of the examples' own form, that holds them all.
    """
    if len(examples) == 0:
        return 1.0
    lifted_examples, lifted = _lift(examples, frames, ridge)
    inverse = _inverse(lifted_examples, ridge)
    limit = _leverage(inverse, lifted_examples).max()
    return float(np.mean(_leverage(inverse, lifted) > limit * (1 + 1e-9)))


def next_frames(examples, frames, eligible, count, ridge=RIDGE):
    """Choose the frames whose tuning would teach most, one after another.

    Each is the eligible frame of greatest leverage over the examples and the frames before it,
    which maximises ``det (sum z z' + ridge I)`` greedily (a D-optimal design).

    Parameters
    ----------
    examples : (N, C) float array
        N may be 0.
    frames : (T, C) float array
    eligible : (T,) bool array
    count : int
        At most; fewer where fewer frames are eligible.
    ridge : float

    Returns
    -------
    list of int
        Rows of the frames, in the order of choice.
    """
    lifted_examples, lifted = _lift(examples, frames, ridge)
    inverse = _inverse(lifted_examples, ridge)
    free = np.array(eligible, bool)
    reach = _leverage(inverse, lifted)
    chosen = []
    while len(chosen) < count and free.any():
        row = int(np.where(free, reach, -1.0).argmax())
        chosen.append(row)
        free[row] = False
        along = inverse @ lifted[row]
        inverse = inverse - np.outer(along, along) / (1 + lifted[row] @ along)
        reach = _leverage(inverse, lifted)
    return chosen


def _lift(examples, frames, ridge):
    """Return examples and frames as rows ``(1, (x - m) / s)``."""
    frames = np.asarray(frames, float)
    examples = np.asarray(examples, float) if len(examples) else np.zeros((0, frames.shape[1]))
    if examples.shape[1] != frames.shape[1] or not ridge > 0:
        message = f"examples {examples.shape} and frames {frames.shape}, ridge {ridge}"
        raise ValueError(f"{message}: needs the same coordinates and a positive ridge")
    mean = frames.mean(axis=0)
    size = np.sqrt(np.mean(np.sum((frames - mean) ** 2, axis=1))) or 1.0
    parts = ((part - mean) / size for part in (examples, frames))
    return [np.hstack([np.ones((len(part), 1)), part]) for part in parts]


def _inverse(lifted, ridge):
    """Return ``(sum z z' + ridge I)^-1``."""
    return np.linalg.inv(lifted.T @ lifted + ridge * np.eye(lifted.shape[1]))


def _leverage(inverse, lifted):
    """Return ``z' A^-1 z`` of every row."""
    return np.sum((lifted @ inverse) * lifted, axis=1)
