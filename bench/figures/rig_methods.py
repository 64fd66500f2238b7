"""Weights of the clay head on a marker take, by what Deng et al. compare and by better choices."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench.figures import example
from stages.core import (
    equation,
    head_transform,
    kept_moments,
    local_shapes,
    partial_projection,
    regression_choice,
    weight_regression,
)
from stages.files import actor_points, channels, driving_points, pairs, rig, virtual_markers

ACTOR, CHARACTER, SHOT, OTHERS = "mia", "clay", "capture", ("rom", "talk", "turn")
DIMENSIONS = 4  # D06 section 5
MIN_CONFIDENCE = 0.5
MOVES_CM, MM = 0.01, 10.0
EQUATION, CLIP, PUBLISHED, LINEAR = "positions", "clip", "rbf", "rbf_linear"


class Played(NamedTuple):
    """Hold a take and what drives the clay head in it.

    Attributes
    ----------
    driving : driving_points.DrivingPoints
    character : rig.Rig
    deltas : (K, V, 3) float array [cm]
    tuned : (N,) int array
        The frames of the pairs.
    weights : dict of (T, K) float arrays
        Of each method, and of the truth.
    """

    driving: driving_points.DrivingPoints
    character: rig.Rig
    deltas: np.ndarray
    tuned: np.ndarray
    weights: dict[str, np.ndarray]


def play(show: Path) -> Played:
    """Find the weights of every frame by each method."""
    expression = example.of_shot(show, SHOT, "expression.parquet")
    driving = driving_points.read(expression, "markers")
    character = rig.read(example.rig(show, CHARACTER, ACTOR), "mesh")
    folder = show / "data_example" / "characters" / CHARACTER
    limits = channels.read(folder / "channels.tsv", character.names, 0.0, 1.0)
    points = actor_points.read([expression], [SHOT], "markers")
    tuned = pairs.read(sorted((folder / "pairs").glob("*.tsv")), points.shots, OTHERS, limits)
    weights = _solved(driving, character, folder / "virtual_markers.tsv", limits)
    weights |= _predicted(expression, points, tuned, limits)
    weights["true"] = _true(show, character, len(driving.frame))
    deltas = local_shapes.dense(character.deltas)
    frames = np.array([pair.frame for pair in tuned])
    return Played(driving, character, deltas, frames, weights)


def _solved(driving, character, path, limits):
    """Return the weights of both equation solves, within what the rig takes."""
    listed = virtual_markers.read(path, driving.names, len(character.neutral))
    axes = head_transform.face_axes(character.up_axis) / character.face_unit
    places, deltas = (
        np.einsum("mn,...mnd->...md", listed.shares, array[..., listed.vertices, :]) @ axes
        for array in (character.neutral, local_shapes.dense(character.deltas))
    )
    blinks = np.array(kept_moments.kinds(character.names, limits.keep)) == kept_moments.BLINK
    strength = limits.strength * np.where(blinks, equation.BLINK_STRENGTH, 1.0)
    seen, neutral = driving.points[:, listed.points], driving.neutral[listed.points]
    given = (places, deltas)
    bounds = (limits.low, limits.high, strength, float(driving.rate))
    found = {}
    for method in (EQUATION, CLIP):
        weights = equation.solve(seen, neutral, *given, method, *bounds).weights
        found[method] = np.clip(weights, limits.low, limits.high)
    return found


def _predicted(expression, points, tuned, limits):
    """Return the weights of both regressions, each with the rig's limits."""
    most = regression_choice.MOST
    axes, noise = actor_points.axes(expression, points, MIN_CONFIDENCE, most)
    frames = partial_projection.project(axes, noise, points.offsets)
    rows = [points.shots[pair.shot][pair.frame] for pair in tuned]
    targets = np.stack([pair.weights for pair in tuned])
    found = {}
    for method, dimensions in ((PUBLISHED, DIMENSIONS), (LINEAR, None)):
        form = regression_choice.choose(
            frames[rows], targets, method, dimensions, usual_width=method == PUBLISHED
        )
        trained, _ = weight_regression.train(frames[rows], targets, form)
        weights = weight_regression.predict(trained, frames)
        found[method] = np.clip(weights, limits.low, limits.high)
    return found


def _true(show, character, count):
    """Return the weights that the generator knows."""
    known = np.load(example.truth(show, SHOT))
    names = list(known["weight_names"])
    order = [names.index(name.split(".")[1]) for name in character.names]
    return known["weights"][:count, order].astype(float)


def errors_mm(played: Played, method: str) -> np.ndarray:
    """Return the mean distance (T,) of the vertices that any shape moves from the truth [mm]."""
    true = played.weights["true"]
    wrong = played.weights[method][: len(true)] - true
    moving = np.linalg.norm(played.deltas, axis=2).max(axis=0) > MOVES_CM
    flat = played.deltas[:, moving].reshape(len(played.deltas), -1)
    moves = (wrong @ flat).reshape(len(wrong), -1, 3)
    return MM * np.linalg.norm(moves, axis=2).mean(axis=1)
