"""Head turns as suit a character's nature: about other axes, larger or smaller, and only so far.

Turns are rotation vectors (`rotation_vectors`): a nod, a shake or a tilt by itself is scaled
exactly, and a turn that is all three has no gimbal to lock.
"""

import numpy as np

# of the limit: up to here turns stay as they are
FREE = 0.5


def shaped(
    turns: np.ndarray, axes: np.ndarray, gain: np.ndarray, limit: float | None
) -> np.ndarray:
    """Turn a head about other axes, by another amount and within a limit.

    Parameters
    ----------
    turns : (T, 3) float array about x, y and z: nod, shake, tilt [rad]; NaN where not known
    axes : (3, 3) float array, a row for each axis of the character: which of the actor's turns it
        shows, with which sign
    gain : (3,) float array, factors of nod, shake and tilt
    limit : the largest angle [rad], or None

    Returns
    -------
    (T, 3) float array [rad]

    Raises
    ------
    ValueError
        if the axes are not three signed ones or the limit is not above zero
    """
    if axes.shape != (3, 3) or not np.array_equal(np.abs(axes) @ np.abs(axes).T, np.eye(3)):
        raise ValueError(f"axes {axes.tolist()} are not three different signed ones")
    made = gain * (turns @ axes.T)
    return made if limit is None else limited(made, limit)


def limited(turns: np.ndarray, limit: float) -> np.ndarray:
    """Keep turns within an angle, softly.

    Up to `FREE` of the limit an angle stays; what exceeds it approaches the limit as tanh does, at
    first by as much as before, so that no motion stops abruptly.

    Parameters
    ----------
    turns : (T, 3) float array [rad]
    limit : the angle that is never reached [rad]
    """
    if not limit > 0.0:
        raise ValueError(f"limit {limit} is not above zero")
    angle = np.linalg.norm(turns, axis=1, keepdims=True)
    free, rest = FREE * limit, (1.0 - FREE) * limit
    softened = free + rest * np.tanh((angle - free) / rest)
    return np.where(angle > free, turns * softened / np.where(angle > 0.0, angle, 1.0), turns)


def read_axes(text: str) -> np.ndarray:
    """Return the (3, 3) axes of three signed letters such as `x -y z`.

    Raises
    ------
    ValueError
        if the text is none such
    """
    words = text.split()
    letters = [word.lstrip("+-") for word in words]
    signs = [word[: len(word) - len(letter)] for word, letter in zip(words, letters, strict=True)]
    if sorted(letters) != ["x", "y", "z"] or not set(signs) <= {"", "+", "-"}:
        raise ValueError(f"'{text}' is not x, y and z in some order, each with or without a minus")
    rows = np.zeros((3, 3))
    for row, (letter, sign) in enumerate(zip(letters, signs, strict=True)):
        rows[row, "xyz".index(letter)] = -1.0 if sign == "-" else 1.0
    return rows
