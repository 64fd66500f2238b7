"""What the figures need of a take that layers drive: weights, coefficients, points, character."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench.figures import example
from data_example.generator import capture, render
from stages.core import local_shapes
from stages.files import layers, rig, series, simplices

ACTOR, SHOT, CHARACTER = "mia", "vignette", "tortoise"
COLOURS = {"emotion": "#D55E00", "speech": "#0072B2", "blink": "#009E73"}
LIP_MASK = "mouth"


class LayerTake(NamedTuple):
    """Hold a take, the simplices behind it and the character that it moves.

    Attributes
    ----------
    solved : layers.Layers
    made : simplices.Simplices
    character : rig.Rig
    shown : (T, K) float array
        How much of each of the rig's shapes each frame shows, zero where nothing is known.
    """

    solved: layers.Layers
    made: simplices.Simplices
    character: rig.Rig
    shown: np.ndarray


def paths(show: Path) -> list[Path]:
    """Return the files that the figures of layers need."""
    names = ("layers.parquet", "directed.parquet")
    return [
        simplices_path(show),
        example.rig(show, CHARACTER, ACTOR),
        *(example.of_take(show, SHOT, CHARACTER, name) for name in names),
    ]


def simplices_path(show: Path) -> Path:
    """Return the extremes that actor and character share."""
    return example.rig(show, CHARACTER, ACTOR).with_name("simplices.npz")


def film_path(show: Path, shot: str = SHOT) -> Path:
    """Return the film of a shot of the session."""
    return show / "data_example" / "play" / f"{shot}.mp4"


def read(show: Path) -> LayerTake:
    """Read the take of the example show."""
    character = rig.read(example.rig(show, CHARACTER, ACTOR), "mesh")
    directed = series.read(example.of_take(show, SHOT, CHARACTER, "directed.parquet"), "directed")
    shown = np.stack([directed.columns[name] for name in character.names], axis=1)
    return LayerTake(
        layers.read(example.of_take(show, SHOT, CHARACTER, "layers.parquet")),
        simplices.read(simplices_path(show)),
        character,
        np.nan_to_num(shown),
    )


def outputs(take: LayerTake, frames: list[int], layer: str | None = None) -> np.ndarray:
    """Return the character (N, V, 3) as a layer, or all of them, moves it, weights included."""
    character = take.character
    own = [layer in (None, layer_of(name)) for name in character.names]
    masked = local_shapes.masked(character.deltas, character.masks, character.mask_index)
    weights = take.shown[np.searchsorted(take.solved.frame, frames)] * own
    moved = weights @ local_shapes.dense(masked).reshape(len(own), -1)
    return character.neutral + moved.reshape(len(frames), *character.neutral.shape)


def layer_of(name: str) -> str:
    """Return the layer of a rig's shape `<mask>.<layer>_<name>`."""
    return name.split(".", 1)[1].split("_", 1)[0]


def weighted_masks(weights: np.ndarray, masks: np.ndarray) -> np.ndarray:
    """Return how much each layer has to say at every place (T, J, V), ``sum_l w_lj M_l``.

    Parameters
    ----------
    weights : (T, R, J) float array
    masks : (R, V) float array
    """
    return np.einsum("trj,rv->tjv", weights, masks)


def in_picture(show: Path, take: LayerTake, frames: list[int]) -> np.ndarray:
    """Return where the points of the simplices lie in the film (N, P, 2) [px].

    The example's film was made by a camera of known place, which markers are brought to.
    """
    path = example.of_shot(show, SHOT, "performance.parquet")
    performance = series.read(path, "performance")
    rows = np.searchsorted(performance.frame, frames)
    right, back, up = capture.SEAT
    seat = np.array([right, up, -back])
    places = []
    for group in take.made.layout:
        axes = "xyz" if group.kind == "markers" else "xy"
        points = series.stack(performance, path, group.names, axes)[rows]
        if group.kind == "markers":
            points = capture.PICTURE / render.WIDTH * render.project(points - seat)
        places.append(points)
    return np.concatenate(places, axis=1)
