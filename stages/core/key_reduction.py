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
    local_shapes,
    mesh_error,
    target_pruning,
)

# the first thinning spends this share of the tolerance, the removal one by one the rest
START = 0.25
ROUNDS = 4
# vertices that a round adds to the watched
WATCHED = 48


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
    removal = key_removal.Removal(values, thinned(values, share), reach)
    watched = _most_often(mesh_error.worst(parts, removal.wrong)[1])
    _put_back(removal, parts, shapes, tolerance)
    for _ in range(ROUNDS):
        removal.run(local_shapes.at(shapes, watched), tolerance)
        found = _put_back(removal, parts, shapes, tolerance)
        if not len(found):
            break
        watched = np.union1d(watched, _most_often(found))
    return removal.kept, float(mesh_error.worst(parts, removal.wrong)[0].max())


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
    return np.stack([key_removal.error(curve, rows) for curve, rows in channels], axis=1)


def _put_back(
    removal: key_removal.Removal,
    parts: list[compose.Block],
    shapes: local_shapes.LocalShapes,
    tolerance: float,
) -> np.ndarray:
    """Put keys back until the bound holds at all vertices; return the vertices that broke it.

    A frame at which all channels are keys has no error, so this ends.
    """
    found = []
    while True:
        largest, vertex = mesh_error.worst(parts, removal.wrong)
        broken = np.flatnonzero(largest > tolerance)
        if not len(broken):
            return np.array(found, int)
        found += vertex[broken].tolist()
        for frame, deltas in zip(
            broken, local_shapes.at(shapes, vertex[broken]).swapaxes(0, 1), strict=True
        ):
            _free(removal, int(frame), deltas, tolerance)


def _free(removal: key_removal.Removal, frame: int, deltas: np.ndarray, tolerance: float) -> None:
    """Make those channels keys that move a vertex most, until it is near; deltas are (K, D)."""
    moved = np.inf
    while np.linalg.norm(moved) > tolerance:
        parts = removal.wrong[frame][:, None] * deltas
        removal.insert(int((parts @ parts.sum(axis=0)).argmax()), frame)
        moved = removal.wrong[frame] @ deltas
