"""Find where a character's lips meet, and how far each of its poses parts them.

Lips meet where vertices that touch while the lips are closed part in some other pose. That needs
no list of vertices, works for any number of mouths, and asks only for a pose with closed lips.
"""

import numpy as np

TOUCH = 0.0125  # how near two vertices of closed lips are [face units], 0.5 % of a face's height
PART = 0.075  # how far apart they come in some pose [face units]
ALONG = 0.3  # how near pairs of one mouth follow one another [face units]


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


def mouths(points: np.ndarray) -> np.ndarray:
    """Return the mouth (M,) of each pair by its place (M, 3).

    Pairs that a chain of steps of at most `ALONG` joins are of one mouth. Pieces of the mesh do not
    tell: lips may be pieces apart from lining and teeth, and one skin may hold several mouths.
    """
    # dense lips have thousands of pairs, yet few places a touch apart
    cells, cell = np.unique(np.round(points / TOUCH), axis=0, return_inverse=True)
    near = np.linalg.norm(cells[:, None] - cells, axis=2) <= ALONG / TOUCH
    mouth, before = np.arange(len(cells)), None
    while not np.array_equal(mouth, before):
        mouth, before = np.where(near, mouth, len(cells)).min(axis=1), mouth
    return np.unique(mouth[cell.ravel()], return_inverse=True)[1]


def gaps(shapes: np.ndarray, closed: int) -> np.ndarray | None:
    """Return how far each mouth is open in every pose (G, K) [face units]; None where none meet.

    The root mean square over a mouth's pairs of how much further apart than in the closed pose they
    are, so that a mouth which rests open in its middle alone shows; what half of `TOUCH` hides
    counts as closed. The gap of a mix of poses is at most the mix of their gaps.

    Parameters
    ----------
    shapes, closed : see `pairs`
    """
    found = pairs(shapes, closed)
    if not len(found):
        return None
    still = _apart(shapes[closed], found) + 0.5 * TOUCH
    opened = np.array([np.maximum(_apart(shape, found) - still, 0.0) for shape in shapes])
    mouth = mouths(shapes[closed][found].mean(axis=1))
    square = [np.mean(opened[:, mouth == g] ** 2, axis=1) for g in range(mouth.max() + 1)]
    return np.sqrt(square)


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
