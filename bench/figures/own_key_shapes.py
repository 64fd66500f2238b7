"""A second sequence with key shapes of its own, against those of the range-of-motion take.

The sculpts are the example's own: true poses of the generator's characters, off as a sculptor's
would be, so what the target should do is known on every frame.
"""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench.figures import example, region_frames
from data_example.generator import drawing, human_mesh, params, radio, sculpting
from stages.core import compose, key_weights, local_shapes, region_features
from stages.files import key_shapes, region_settings, regions, rig

BASIS, SHOT = "rom", "turn"
COUNTS = {"mouth": 14, "eyes": 8, "pupils": 5}  # CB02 section 5; it gives no number of pupils
DRAWS = 5
MODELS = {"human": human_mesh, "radio": radio, "drawing": drawing}
SHOWN, SAME, OWN = "show", "basis", "own"


class KeySet(NamedTuple):
    """Hold a region's key shapes.

    Attributes
    ----------
    origin : list of (shot, frame)
    shapes : (K, P, 2) float array [face units]
    """

    origin: list[tuple[str, int]]
    shapes: np.ndarray


class Sequence(NamedTuple):
    """Hold the sequence and three choices of key shapes.

    Attributes
    ----------
    frame : (T,) int array, frames on which every region was tracked well
    regions : dict region -> region_frames.RegionFrames, of these frames
    settings : dict region -> region_settings.Settings
    chosen : dict of dict region -> KeySet
        `SHOWN`: the show's own choice; `SAME`: as many as `COUNTS`, of the basis shot; `OWN`:
        as many, of the sequence.
    """

    frame: np.ndarray
    regions: dict[str, region_frames.RegionFrames]
    settings: dict[str, region_settings.Settings]
    chosen: dict[str, dict[str, KeySet]]


def read(show: Path) -> Sequence:
    """Read the sequence and choose its key shapes by the show's own methods."""
    table = regions.read(show / "config" / "regions.tsv")
    settings = region_settings.read(show / "config" / "region_settings.tsv", table)
    moving = {region: region_frames.read(show, SHOT, region) for region in table}
    frame = sorted(set.intersection(*(set(own.frame.tolist()) for own in moving.values())))
    moving = {region: _at(own, frame) for region, own in moving.items()}
    basis = {region: region_frames.read(show, BASIS, region) for region in table}
    chosen = {
        SHOWN: _shown(show, table),
        SAME: {r: _choose(BASIS, basis[r], COUNTS[r], settings[r]) for r in table},
        OWN: {r: _choose(SHOT, moving[r], COUNTS[r], settings[r]) for r in table},
    }
    return Sequence(np.array(frame), moving, settings, chosen)


def solve(sequence: Sequence, name: str) -> tuple[dict[str, np.ndarray], dict[str, float]]:
    """Solve the sequence's weights on one choice of key shapes, by the show's settings.

    Returns
    -------
    weights : dict region -> (T, K) float array
    error : dict region -> float
        Root mean square distance of a point from the tracked one [face units].
    """
    weights, error = {}, {}
    for region, own in sequence.regions.items():
        frames, neutral = region_frames.features(own)
        shapes = region_features.stack(sequence.chosen[name][region].shapes, own.weights)
        setting = sequence.settings[region]
        solution = key_weights.solve(
            frames, shapes, neutral, setting.solve, setting.sigma, setting.bound
        )
        weights[region] = solution.weights
        error[region] = float(np.sqrt(np.mean(solution.residual**2)))
    return weights, error


class Target(NamedTuple):
    """Hold a character of the example whose true pose is known on every frame.

    Attributes
    ----------
    rig : rig.Rig
    pose : callable
        From expression parameters to (V, 3) positions.
    rows : dict shot -> (T, N) float array, the true expression parameters
    neutral : (V, 3) float array [character's unit]
    truth : (T, V, 3) float array [character's unit], of the sequence's frames
    """

    rig: rig.Rig
    pose: Callable[[dict], np.ndarray]
    rows: dict[str, np.ndarray]
    neutral: np.ndarray
    truth: np.ndarray


def target(show: Path, name: str, frame: np.ndarray) -> Target:
    """Build one of `MODELS` and pose it as the truth says on some frames of the sequence."""
    model = MODELS[name].build(params.neutral())
    rows = {shot: np.load(example.truth(show, shot))["expression"] for shot in (BASIS, SHOT)}
    return Target(
        rig.read(example.rig(show, name), "mesh"),
        model.pose,
        rows,
        model.pose(params.neutral()),
        np.stack([model.pose(params.from_row(row)) for row in rows[SHOT][frame]]),
    )


def sculpted(character: Target, chosen: dict[str, KeySet], draw: int) -> local_shapes.LocalShapes:
    """Return the masked differences of a sculptor's key shapes, region after region."""
    masks = character.rig.mask_names
    deltas, index = [], []
    for region, keys in chosen.items():
        for shot, frame in keys.origin:
            p = params.only(params.from_row(character.rows[shot][frame]), region)
            generator = np.random.default_rng([draw, (BASIS, SHOT).index(shot), frame])
            made = sculpting.sculpt(character.neutral, character.pose(p), generator)
            deltas.append(made - character.neutral)
            index.append(masks.index(region))
    return local_shapes.masked(local_shapes.gather(deltas), character.rig.masks, np.array(index))


def play(
    character: Target, chosen: dict[str, KeySet], weights: dict[str, np.ndarray], draw: int
) -> np.ndarray:
    """Return the positions (T, V, 3) that weights give a character, without head motion."""
    masked = sculpted(character, chosen, draw)
    rows = np.concatenate([weights[region] for region in chosen], axis=1)
    return compose.compose(character.neutral, compose.blocks(masked), rows)


def target_error(
    character: Target, chosen: dict[str, KeySet], weights: dict[str, np.ndarray]
) -> np.ndarray:
    """Return the error (T,) in the target, root mean square over `DRAWS` sculptors [face units]."""
    played = (play(character, chosen, weights, draw) for draw in range(DRAWS))
    unit = character.rig.face_unit
    errors = [vertex_error(moved, character.truth, character.neutral, unit) for moved in played]
    return np.sqrt(np.mean(np.square(errors), axis=0))


def vertex_error(
    positions: np.ndarray, truth: np.ndarray, neutral: np.ndarray, unit: float
) -> np.ndarray:
    """Return the root mean square distance over the vertices that move, in units.

    Parameters
    ----------
    positions, truth : (T, V, 3) float array
    neutral : (V, 3) float array
    unit : float
        Vertices count whose truth is ever a hundredth of it from the neutral.

    Returns
    -------
    (T,) float array
    """
    moves = np.linalg.norm(truth - neutral, axis=2).max(axis=0) > 0.01 * unit
    squares = ((positions - truth)[:, moves] ** 2).sum(axis=2)
    return np.sqrt(squares.mean(axis=1)) / unit


def _at(own: region_frames.RegionFrames, frame: list[int]) -> region_frames.RegionFrames:
    """Return a region at some of its frames."""
    rows = np.isin(own.frame, frame)
    return own._replace(points=own.points[rows], frame=own.frame[rows])


def _choose(
    shot: str, own: region_frames.RegionFrames, count: int, setting: region_settings.Settings
) -> KeySet:
    """Choose key shapes from a region's frames."""
    rows = region_frames.choose(*region_frames.features(own), count, setting.method, setting.sigma)
    return KeySet([(shot, int(own.frame[row])) for row in rows], own.points[rows])


def _shown(show: Path, table: regions.Regions) -> dict[str, KeySet]:
    """Return the key shapes that the show's characters are sculpted for."""
    rows = key_shapes.read(example.of_actor(show, "key_shapes.parquet"))
    found = {}
    for region in table:
        own = [row for row in rows if row.region == region]
        shapes = np.array([row.shape for row in own]).reshape(len(own), -1, 2)
        found[region] = KeySet([(row.shot, row.frame) for row in own], shapes)
    return found
