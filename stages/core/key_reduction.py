"""Few keys for curves that move a mesh, bounded by what the mesh shows.

Curves and reduced curves are linear between whole frames. So is the displacement of a vertex, and
its length is convex: between two frames it is never more than at the worse of the two. What holds
at every frame holds at half frames and at any time between.
"""

import numpy as np

from stages.core import (
    compose,
    douglas_peucker,
    key_removal,
    keyed_curves,
    local_shapes,
    mesh_error,
    target_pruning,
)

# the first thinning spends this share of the tolerance, the removal one by one the rest
START = 0.25
ROUNDS = 6
# vertices that a round adds to the watched
WATCHED = 48
# what is put right stays below the tolerance by more than sums differ in another order
NEAR = 1 - 1e-9


def reduce(
    values: np.ndarray, shapes: local_shapes.LocalShapes, tolerance: float
) -> tuple[np.ndarray, float]:
    """Choose keys so that no vertex moves farther than a tolerance.

        minimise    number of keys
        subject to  max_tv | sum_k (line_k(t) - u_k(t)) d_k(v) | <= tolerance

    Keys that matter least, ``reach_k max_t |line_k - u_k|``, are taken out first, each only if the
    bound holds at watched vertices with all that was taken out before. All vertices are checked
    after that; those that fail are watched from then on, and keys put back.

    Parameters
    ----------
    values : (T, K) float array, curves `u`
    shapes : K shapes under their masks `d` [character's unit]
    tolerance : largest displacement [character's unit]

    Returns
    -------
    (T, K) bool array
        The keys.
    float
        The largest displacement of any vertex at any time [character's unit].

    Raises
    ------
    ValueError
        if the forms do not fit, there is no frame, or the tolerance is not positive
    """
    count = len(shapes.first) - 1
    if values.ndim != 2 or values.shape[1] != count or not len(values) or not tolerance > 0:
        raise ValueError(f"cannot reduce {values.shape} for {count} shapes within {tolerance}")
    parts = compose.blocks(shapes)
    reach = target_pruning.reach(shapes)
    # a channel that moves nothing may be anything: its tolerance is without limit
    share = np.divide(START * tolerance, reach, out=np.full(count, np.inf), where=reach > 0)
    curves = keyed_curves.KeyedCurves(values, thinned(values, share))
    removal = key_removal.Removal(curves, reach)
    watched = _most_often(mesh_error.worst(parts, curves.wrong.T)[1])
    _settle(curves, local_shapes.at(shapes, watched), np.arange(len(values)), tolerance)
    for _ in range(ROUNDS):
        before = curves.kept.sum()
        removal.run(local_shapes.at(shapes, watched), tolerance)
        removed = before - curves.kept.sum()
        worst, found = _put_back(curves, parts, shapes, tolerance)
        if not len(found) and not removed:
            break
        watched = np.concatenate([watched, np.setdiff1d(_most_often(found), watched)])
    return curves.kept.T, worst


def _most_often(vertices: np.ndarray) -> np.ndarray:
    """Return those that stand most often in a list of vertices, each once."""
    unique, counts = np.unique(vertices, return_counts=True)
    return unique[np.argsort(-counts, kind="stable")[:WATCHED]]


def thinned(values: np.ndarray, tolerance: np.ndarray) -> np.ndarray:
    """Return the keys (T, K) of curves (T, K), each by itself within its tolerance (K,)."""
    kept = np.zeros(values.shape, bool)
    for channel, most in enumerate(tolerance):
        kept[douglas_peucker.keys(values[:, channel], most), channel] = True
    return kept


def error(values: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Return lines between keys (T, K) less their curves (T, K)."""
    channels = zip(values.T, kept.T, strict=True)
    return np.stack([keyed_curves.error(curve, rows) for curve, rows in channels], axis=1)


def _put_back(
    curves: keyed_curves.KeyedCurves,
    parts: list[compose.Block],
    shapes: local_shapes.LocalShapes,
    tolerance: float,
) -> tuple[float, np.ndarray]:
    """Put keys back until the bound holds at all vertices.

    A frame at which all channels are keys has no error, so this ends. Only frames at which errors
    changed are looked at again, first at those vertices that broke the bound anywhere.

    Returns
    -------
    float
        the largest displacement [character's unit]
    (N,) int array
        the vertices that broke the bound, one for each frame that they did it at
    """
    largest, vertex = mesh_error.worst(parts, curves.wrong.T)
    found = [vertex[largest > tolerance]]
    while len(rows := np.flatnonzero(largest > tolerance)):
        suspects = local_shapes.at(shapes, np.unique(found[-1]))
        rows = _settle(curves, suspects, rows, tolerance)
        largest[rows], vertex[rows] = mesh_error.worst(parts, curves.wrong.T[rows])
        found.append(vertex[rows][largest[rows] > tolerance])
    return float(largest.max()), np.concatenate(found)


def _settle(
    curves: keyed_curves.KeyedCurves, deltas: np.ndarray, rows: np.ndarray, tolerance: float
) -> np.ndarray:
    """Put keys back until the bound holds at some vertices, deltas (K, n, D).

    Takes the frames to look at, returns those at which errors changed.
    """
    changed = np.zeros(curves.values.shape[1], bool)
    while len(rows):
        moved = np.tensordot(curves.wrong.T[rows], deltas, axes=1)
        squares = np.einsum("tnd,tnd->tn", moved, moved)
        place = squares.argmax(axis=1)
        broken = squares[np.arange(len(rows)), place] > (NEAR * tolerance) ** 2
        now = np.zeros(len(changed), bool)
        for frame, worst in zip(rows[broken], place[broken], strict=True):
            for low, high in _free(curves, int(frame), deltas[:, worst], NEAR * tolerance):
                now[low : high + 1] = True
        rows = np.flatnonzero(now)
        changed |= now
    return np.flatnonzero(changed)


def _free(
    curves: keyed_curves.KeyedCurves, frame: int, deltas: np.ndarray, tolerance: float
) -> list[tuple[int, int]]:
    """Make those channels keys that move a vertex most, until it is near; deltas are (K, D).

    Returns the spans of frames at which errors became others.
    """
    spans = []
    while np.linalg.norm(curves.wrong[:, frame] @ deltas) > tolerance:
        parts = curves.wrong[:, frame][:, None] * deltas
        spans.append(curves.insert(int((parts @ parts.sum(axis=0)).argmax()), frame))
    return spans
