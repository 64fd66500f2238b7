"""Find where a character's lips meet, and how far each of its poses parts them.

Lips meet where vertices that touch while the lips are closed part in some other pose. That needs
no list of vertices, works for any number of mouths, and asks only for a pose with closed lips.
"""

import numpy as np

TOUCH = 0.0125  # how near two vertices of closed lips are [face units], 0.5 % of a face's height
PART = 0.075  # how far apart they come in some pose [face units]


def pairs(shapes: np.ndarray, closed: int) -> np.ndarray:
    """Return the pairs of vertices (M, 2) that touch in the closed pose and part in another.

    Parameters
    ----------
    shapes : (K, N, 3) float array [face units], the lips' vertices in every pose
    closed : the pose with closed lips
    """
    touching = _touching(shapes[closed])
    widest = np.zeros(len(touching))
    for shape in shapes:
        widest = np.maximum(widest, _apart(shape, touching))
    return touching[widest > PART]


def gaps(shapes: np.ndarray, closed: int) -> np.ndarray | None:
    """Return how far the lips are open in every pose (K,) [face units]; None where none meet.

    The mean over the pairs of how much further apart than in the closed pose they are; what half of
    `TOUCH` hides counts as closed.

    Parameters
    ----------
    shapes, closed : see `pairs`
    """
    found = pairs(shapes, closed)
    if not len(found):
        return None
    still = _apart(shapes[closed], found) + 0.5 * TOUCH
    return np.array([np.maximum(_apart(shape, found) - still, 0.0).mean() for shape in shapes])


def _touching(points: np.ndarray) -> np.ndarray:
    """Return the pairs (M, 2) of points (N, 3) that are nearer than `TOUCH`, by a sweep along x."""
    order = np.argsort(points[:, 0], kind="stable")
    swept, found = points[order], []
    for step in range(1, len(order)):
        ahead, behind = swept[step:], swept[:-step]
        if (ahead[:, 0] - behind[:, 0]).min() > TOUCH:
            break
        near = np.flatnonzero(np.sum((ahead - behind) ** 2, axis=1) < TOUCH**2)
        found.append(np.stack([order[near], order[near + step]], axis=1))
    return np.concatenate(found) if found else np.zeros((0, 2), np.int64)


def _apart(points: np.ndarray, found: np.ndarray) -> np.ndarray:
    """Return the distance (M,) of each pair."""
    return np.linalg.norm(points[found[:, 0]] - points[found[:, 1]], axis=1)
