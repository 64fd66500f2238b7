"""Figure 7 of Kholgade et al.: weighted masks of the actor and the character, over time."""

from pathlib import Path

import numpy as np
from matplotlib import colors

from bench.figures import layer_pictures, layer_take, look, portraits
from stages.files import layer_points

WIDTH, TOP, SCALE = 12.0, 0.25, 0.5  # inches
ASPECT = 0.95
STRETCH_S, COUNT = (7.5, 9.5), 6
WASHED = 0.6  # how far the film is brought to white
NONE = np.array([0.93, 0.93, 0.91])  # colour of a weight of zero


def draw(show: Path, path: Path) -> None:
    """Draw the points of the actor and the vertices of the character by each layer's weight."""
    take = layer_take.read(show)
    frames = stretch(take)
    rows = np.searchsorted(take.solved.frame, frames)
    weights = take.solved.weights[rows]
    points = layer_take.in_picture(show, take, frames)
    filmed, points = layer_pictures.of_film(show, take, frames, points, ASPECT)
    layers = take.solved.layers
    pictures = [[_washed(picture) for picture in filmed]] * len(layers)
    pictures += _characters(take, frames, weights)
    titles = [f"{frame}, {float(frame / take.solved.rate):.1f} s" for frame in frames]
    sheet = len(pictures) * WIDTH / len(frames) / ASPECT + TOP
    height = sheet + SCALE
    whole, drawn = look.page(WIDTH, height, _caption(take, frames))
    names = [f"{who}, {layer}" for who in ("actor", layer_take.CHARACTER) for layer in layers]
    portraits.sheet(drawn, pictures, names, titles, sheet / height)
    of_points = layer_take.weighted_masks(weights, take.made.mask_weights[:, _first(take)])
    panels = iter(drawn.axes)
    for j, layer in enumerate(layers):
        for places, shares in zip(points, of_points[:, j], strict=True):
            style = {"s": 11, "lw": 0.35, "edgecolors": look.INK}
            next(panels).scatter(*places.T, c=blended(shares, layer), **style)
    _scales(drawn, layers, height)
    look.save(whole, path)


def stretch(take: layer_take.LayerTake) -> list[int]:
    """Return frames of the film, evenly spaced over the stretch that is shown."""
    times = np.linspace(*STRETCH_S, COUNT)
    return [2 * round(float(time * take.solved.rate) / 2) for time in times]


def blended(shares: np.ndarray, layer: str) -> np.ndarray:
    """Return the colours (..., 3) of shares (...) of a layer."""
    full = np.array(colors.to_rgb(layer_take.COLOURS[layer]))
    return NONE + shares[..., None] * (full - NONE)


def _first(take):
    """Return the first coordinate of every point."""
    return np.unique(layer_points.point_of(take.made.layout), return_index=True)[1]


def _washed(picture):
    """Return a picture without colours, brought near to white."""
    grey = picture.mean(axis=2, keepdims=True)
    pale = 255 * WASHED + (1 - WASHED) * grey
    return np.repeat(np.rint(pale), 3, axis=2).astype(np.uint8)


def _characters(take, frames, weights):
    """Return a row of pictures of the character for each layer, shaded by its weight."""
    shares = layer_take.weighted_masks(weights, take.character.masks)
    tints = [blended(shares[:, j], layer) for j, layer in enumerate(take.solved.layers)]
    shapes = np.tile(layer_take.outputs(take, frames), (len(tints), 1, 1))
    pictures = layer_pictures.characters(take, shapes, ASPECT, np.concatenate(tints))
    count = len(frames)
    return [pictures[start : start + count] for start in range(0, len(pictures), count)]


def _scales(drawn, layers, height):
    """Draw what the colours stand for."""
    for column, layer in enumerate(layers):
        place = (0.05 + 0.325 * column, 0.22 / height, 0.2, 0.13 / height)
        panel = drawn.add_axes(place)
        panel.imshow(
            blended(np.linspace(0, 1, 256)[None], layer), aspect="auto", extent=(0, 1, 0, 1)
        )
        panel.set(xticks=(0, 0.5, 1), yticks=[])
        panel.tick_params(labelsize=8, length=2, pad=1)
        panel.text(1.04, 0.5, f"weight of {layer}", va="center", size=9.5, color=look.INK)


def _caption(take, frames):
    """Return the caption."""
    start, end = (float(frame / take.solved.rate) for frame in (frames[0], frames[-1]))
    markers, video = (len(group.names) for group in take.made.layout)
    return (
        f"Figure 7 of Kholgade et al. Weighted masks over a stretch of the take "
        f"'{layer_take.SHOT}', from {start:.1f} to {end:.1f} s, where rage gives way to sadness: "
        "how much each layer has to say at every point of the actor and at every vertex of the "
        f"{layer_take.CHARACTER}. The same weights of the masks {', '.join(take.solved.masks)} go "
        f"to both. Above, {markers} markers and {video} points of the film, over the film; below, "
        "the mesh as the layers pose it, without the head's motion. The layers' weights sum to "
        "one everywhere; where masks overlap they blend."
    )
