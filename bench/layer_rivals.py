"""Drive the clay head through the vignette by key shapes and by an RBF network."""

import numpy as np

from bench import layer_vignette
from stages.core import (
    key_shape_candidates,
    key_shape_selection,
    key_weights,
    local_shapes,
    partial_projection,
    pca,
    weight_regression,
)
from stages.files import actor_points, driving_points, layer_points, rbf_model, rig

# key shapes of upper face, mouth and eyes: as many as region_settings.tsv asks for the other
# actress, and as many as the layers have poses
COUNTS = ((10, 12, 10), (27, 27, 27))
METHOD, SOLVE, SIGMA, SEED = "shared_residual", "tolerant_even", 0.1, 1


def key_shapes(
    take: layer_vignette.Take, masks: np.ndarray, faces: np.ndarray, counts, kinds: str
) -> np.ndarray:
    """Return displacements (T, V, 3) [mm] of the clay head by key shapes chosen from `faces`.

    Sculpts are the head's own truth on the frames chosen.

    Parameters
    ----------
    masks : (R, V) float array, of the head
    faces : (F, V, 3) float array [mm], the head's truth in `faces`
    counts : key shapes in each mask
    kinds : the points that are seen, `both`, `markers` or `video`
    """
    made = take.made
    points = layer_points.read(take.show / "results/shots/faces/expression.parquet", made.driven_by)
    shown = layer_points.flat(points, made.layout)
    seen_at = layer_vignette.coordinates(made, kinds)
    total = np.zeros((len(take.offsets), faces.shape[1], 3))
    for mask, weight, count in zip(made.mask_weights, masks, counts, strict=True):
        own = (mask > 0) & seen_at
        scale = made.scale[own] * np.sqrt(mask[own])
        seen = shown[:, own] * scale
        whole = np.flatnonzero(np.isfinite(seen).all(axis=1))
        candidates = key_shape_candidates.Candidates(
            seen[whole],
            np.zeros(own.sum()),
            pca.fit(seen[whole]),
            np.ones(len(whole), bool),
            seed=SEED,
            sigma=SIGMA,
        )
        choices = key_shape_selection.choose(candidates, count, METHOD)
        rows = whole[[choice.frame for choice in choices]]
        weights = _solved(take.offsets[:, own] * scale, seen[rows])
        sculpts = faces[points.frame[rows]].reshape(len(rows), -1)
        total += weight[:, None] * (weights @ sculpts).reshape(total.shape)
    return total


def _solved(frames: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Return the weights (T, N) of key shapes, together the frames with the same points."""
    observed = np.isfinite(frames)
    weights = np.zeros((len(frames), len(shapes)))
    for pattern in np.unique(observed, axis=0):
        rows = (observed == pattern).all(axis=1)
        neutral = np.zeros(pattern.sum())
        found = key_weights.solve(
            frames[rows][:, pattern], shapes[:, pattern], neutral, SOLVE, SIGMA
        )
        weights[rows] = found.weights
    return weights


def rbf_network(take: layer_vignette.Take) -> np.ndarray:
    """Return displacements (T, V, 3) [mm] of the clay head by what `capture` taught its network."""
    folder = take.show / "results/cast" / layer_vignette.ACTOR / "clay"
    learnt = rbf_model.read(folder / "rbf.npz")
    path = take.show / "results/shots" / layer_vignette.SHOT / "expression.parquet"
    offsets = actor_points.offsets_of(driving_points.read(path, learnt.points), learnt.point_names)
    at = partial_projection.project(learnt.axes, learnt.noise, offsets)
    weights = np.clip(weight_regression.predict(learnt.regression, at), 0.0, 1.0)
    made = rig.read_any(folder / "rig.npz")
    deltas = local_shapes.dense(made.deltas) * 1000 * rig.METRES[made.unit]
    return (weights @ deltas.reshape(len(deltas), -1)).reshape(len(weights), -1, 3)
