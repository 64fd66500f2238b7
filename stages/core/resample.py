"""Exact resampling in time: linear for values, along the great circle for rotations."""

from fractions import Fraction

import numpy as np


def covered_frames(first: int, count: int, source: Fraction, target: Fraction) -> np.ndarray:
    """Return the frame numbers at the target rate whose times lie within the source's frames.

    Parameters
    ----------
    first : the source's first frame number; frame n stands at n / source seconds
    count : the source's frames
    source, target : frames per second

    Returns
    -------
    (T',) int64 array
    """
    ratio = Fraction(target) / Fraction(source)
    start, end = first * ratio, (first + count - 1) * ratio
    return np.arange(-((-start.numerator) // start.denominator), end // 1 + 1)


def positions(
    frames: np.ndarray, first: int, count: int, source: Fraction, target: Fraction
) -> tuple[np.ndarray, np.ndarray]:
    """Say between which source frames a target frame lies, without rounding.

    Parameters
    ----------
    frames : (T',) int array, frame numbers at the target rate
    first, count, source, target : as in `covered_frames`

    Returns
    -------
    below : (T',) int array, row of the source frame at or before; at most count - 2
    share : (T',) float array in 0..1 of the frame after it
    """
    ratio = Fraction(source) / Fraction(target)
    scaled = frames.astype(np.int64) * ratio.numerator
    below = np.clip(scaled // ratio.denominator - first, 0, max(count - 2, 0))
    share = (scaled - (below + first) * ratio.denominator) / ratio.denominator
    return below, np.clip(share, 0.0, 1.0)


def linear(values: np.ndarray, below: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Interpolate the rows of a (T, ...) array linearly; whole positions come back unchanged."""
    above = np.minimum(below + 1, len(values) - 1)
    part = share.reshape(-1, *[1] * (values.ndim - 1))
    between = (1.0 - part) * values[below] + part * values[above]
    return np.where(part == 0.0, values[below], np.where(part == 1.0, values[above], between))


def slerp(quaternions: np.ndarray, below: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Interpolate rotations along the shorter great circle (Shoemake 1985).

    Parameters
    ----------
    quaternions : (T, 4) float array, of length one
    below, share : from `positions`

    Returns
    -------
    (T', 4) float array; the stored rows themselves at whole positions
    """
    above = np.minimum(below + 1, len(quaternions) - 1)
    start, end = quaternions[below], quaternions[above]
    cosine = np.sum(start * end, axis=1)
    end = np.where(cosine[:, None] < 0, -end, end)
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    sine = np.sin(angle)
    straight = sine < 1e-9
    divisor = np.where(straight, 1.0, sine)
    first = np.where(straight, 1.0 - share, np.sin((1.0 - share) * angle) / divisor)
    second = np.where(straight, share, np.sin(share * angle) / divisor)
    between = first[:, None] * start + second[:, None] * end
    whole = np.where((share == 1.0)[:, None], quaternions[above], between)
    return np.where((share == 0.0)[:, None], quaternions[below], whole)


def continuous(quaternions: np.ndarray) -> np.ndarray:
    """Flip signs so that no rotation of a (T, 4) array jumps to its antipode.

    Viewers that interpolate component by component need that; the rotations stay the same.
    """
    dots = np.sum(quaternions[1:] * quaternions[:-1], axis=1)
    signs = np.cumprod(np.concatenate([[1.0], np.where(dots < 0, -1.0, 1.0)]))
    return quaternions * signs[:, None]


def neighbours(observed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Place every frame between its nearest observed ones; frames outside are held.

    Parameters
    ----------
    observed : (T,) bool array, with at least one True

    Returns
    -------
    below : (T,) int array, index into the observed frames
    share : (T,) float array in 0..1 of the observed frame after it; 0 at observed frames

    Raises
    ------
    ValueError
        if nothing was observed
    """
    known = np.flatnonzero(observed)
    if not len(known):
        raise ValueError("no frame was observed")
    place = np.interp(np.arange(len(observed)), known, np.arange(len(known)))
    below = np.minimum(place.astype(int), len(known) - 1)
    return below, place - below
