"""Leave out the morph targets that matter least, where a viewer evaluates only so many at once.

glTF asks viewers for eight; many drop the rest by rules of their own.
"""

import numpy as np

from stages.core import compose, local_shapes


def reach(targets: local_shapes.LocalShapes) -> np.ndarray:
    """Return how far each target moves a vertex at most (M,) [unit]."""
    lengths = np.linalg.norm(targets.values, axis=1)
    owner = np.repeat(np.arange(len(targets.first) - 1), np.diff(targets.first))
    found = np.zeros(len(targets.first) - 1)
    np.maximum.at(found, owner, lengths)
    return found


def kept(weights: np.ndarray, reached: np.ndarray, most: int) -> np.ndarray:
    """Say which targets stay at which frames, so that at no time more than `most` are active.

    Between two frames a target is active that is so at one of them. So for every step from frame to
    frame the targets with the largest `reach * weight` at either end are chosen, and a target keeps
    its weight at a frame if the steps before and after it both chose it.

    Parameters
    ----------
    weights : (T, M) float array, not negative
    reached : (M,) float array, how far each target moves a vertex at most
    most : targets at once, at least 1

    Returns
    -------
    (T, M) bool array

    Raises
    ------
    ValueError
        if the forms do not fit, or fewer than one target is asked for
    """
    if weights.ndim != 2 or reached.shape != weights.shape[1:] or most < 1:
        raise ValueError(f"cannot keep {most} of weights {weights.shape}, reach {reached.shape}")
    effect = weights * reached
    steps = np.maximum(effect[:-1], effect[1:]) if len(effect) > 1 else effect
    order = np.argsort(-steps, axis=1, kind="stable")
    chosen = np.zeros(steps.shape, bool)
    np.put_along_axis(chosen, order[:, :most], values=True, axis=1)
    before = np.concatenate([chosen[:1], chosen])
    after = np.concatenate([chosen, chosen[-1:]])
    return (before & after)[: len(weights)]


def worst_error(targets: local_shapes.LocalShapes, dropped: np.ndarray, scale: np.ndarray) -> float:
    """Return how far dropped weights would have moved a vertex at most [unit].

    Parameters
    ----------
    targets : M morph targets
    dropped : (T, M) float array, the weights that were left out
    scale : (T,) float array, of the head
    """
    still = np.zeros((targets.count, 3))
    blocks = compose.blocks(targets)
    worst = 0.0
    for frame in np.flatnonzero(dropped.any(axis=1)):
        moved = compose.compose(still, blocks, dropped[frame : frame + 1])[0]
        worst = max(worst, float(scale[frame] * np.linalg.norm(moved, axis=1).max()))
    return worst
