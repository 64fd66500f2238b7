"""Propose frames of an actor that show extremes of speech, emotion and blink."""

from collections.abc import Sequence

import numpy as np

# phones of a viseme among which the most typical is sought: the longest of them
LONGEST_SHARE, LEAST_PHONES = 0.5, 5
# frames whose opening is as wanted within this share of the range
OPENING_TOLERANCE = 0.08


def filled(values: np.ndarray) -> np.ndarray:
    """Return values (T, D) with what is NaN at its coordinate's mean, or 0 where there is none."""
    known = np.isfinite(values)
    counts = np.maximum(known.sum(axis=0), 1)
    return np.where(known, values, np.where(known, values, 0.0).sum(axis=0) / counts)


def told_apart(values: np.ndarray, visemes: Sequence[str]) -> np.ndarray:
    """Return the share (D,) of each coordinate's variance that lies between visemes.

    Points of the mouth differ from viseme to viseme, brows do not: the root of the share, as a
    factor of the coordinates, leaves what speech moves. Without repeated visemes all are 1.

    Parameters
    ----------
    values : (N, D) float array, the face in the middle of N phones
    visemes : N names
    """
    names = np.asarray(visemes)
    groups = [np.flatnonzero(names == name) for name in np.unique(names)]
    if len(groups) < 2 or len(groups) == len(values):
        return np.ones(values.shape[1])
    means = np.stack([values[group].mean(axis=0) for group in groups])
    sizes = np.array([len(group) for group in groups])[:, None]
    centre = values.mean(axis=0)
    between = np.sum(sizes * (means - centre) ** 2, axis=0) / (len(groups) - 1)
    within = sum(np.sum((values[g] - values[g].mean(axis=0)) ** 2, axis=0) for g in groups)
    within = within / (len(values) - len(groups))
    total = between + within
    return np.divide(between, total, out=np.zeros_like(total), where=total > 0)


def typical(values: np.ndarray, lengths: np.ndarray) -> int:
    """Return which of N phones looks most like the others, among the longest of them.

    The medoid: it minimises ``sum_n |x - x_n|``.

    Parameters
    ----------
    values : (N, D) float array, the face in the middle of each
    lengths : (N,) float array, how long each lasts
    """
    count = max(LEAST_PHONES, int(np.ceil(LONGEST_SHARE * len(lengths))))
    longest = np.argsort(-np.asarray(lengths), kind="stable")[:count]
    own = values[longest]
    apart = np.linalg.norm(own[:, None] - own[None], axis=2).sum(axis=1)
    return int(longest[apart.argmin()])


def farthest(values: np.ndarray, eligible: np.ndarray) -> int | None:
    """Return the eligible frame whose values (T, D) are farthest from the neutral, 0; or None."""
    if not eligible.any():
        return None
    return int(np.where(eligible, np.linalg.norm(values, axis=1), -1.0).argmax())


def nearest(values: np.ndarray, eligible: np.ndarray) -> int | None:
    """Return the eligible frame whose values (T, D) are nearest to the neutral, 0; or None."""
    if not eligible.any():
        return None
    return int(np.where(eligible, np.linalg.norm(values, axis=1), np.inf).argmin())


def opening_of_contour(points: np.ndarray) -> np.ndarray:
    """Return how far a closed contour is open, its area over its width squared.

    Parameters
    ----------
    points : (T, P, 2) float array, in order along the contour

    Returns
    -------
    (T,) float array, NaN where a point is
    """
    x, y = np.moveaxis(points, 2, 0)
    area = np.abs(np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1)) / 2
    width = x.max(axis=1) - x.min(axis=1)
    return area / np.where(width > 0, width, np.nan) ** 2


def blink_frames(
    opening: np.ndarray, values: np.ndarray, eligible: np.ndarray, closed_share: float
) -> dict[str, int] | None:
    """Choose frames of open, half open and closed eyes.

    Open is the usual opening, closed the least, half lies midway. Among the frames that have
    nearly the opening that is wanted, the one nearest to the neutral is taken: so a blink in the
    midst of laughter is not.

    Parameters
    ----------
    opening : (T,) float array, NaN where not observed
    values : (T, D) float array, the face less its neutral
    eligible : (T,) bool array
    closed_share : eyes that keep more than this share of their usual opening have not blinked

    Returns
    -------
    `open`, `half` and `closed` and their frames; None where no eye closes
    """
    usable = eligible & np.isfinite(opening)
    if not usable.any():
        return None
    usual, least = np.median(opening[usable]), opening[usable].min()
    if least > closed_share * usual:
        return None
    wanted = {"open": usual, "half": (usual + least) / 2, "closed": least}
    found: dict[str, int] = {}
    for name, level in wanted.items():
        off = np.where(usable, np.abs(opening - level), np.inf)
        off[list(found.values())] = np.inf
        near = off <= max(OPENING_TOLERANCE * (usual - least), off.min())
        frame = nearest(values, near & np.isfinite(off))
        if frame is None:
            return None
        found[name] = frame
    return found
