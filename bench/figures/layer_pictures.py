"""Pictures of a take that layers drive: the film and the character, cut to what they show."""

from pathlib import Path

import numpy as np

from bench.figures import layer_take
from stages.core import head_transform, polygons, portrait
from stages.files import film

SIDE = 900  # px, of what is then cut
EMPTY = 10  # of 255, by which a backdrop may differ from its edge
MARGIN = 0.04  # of what is shown
HAIR = 0.25  # of the points' height, above them


def characters(
    take: layer_take.LayerTake,
    shapes: np.ndarray,
    aspect: float,
    colours: np.ndarray | None = None,
) -> list[np.ndarray]:
    """Draw shapes (N, V, 3) of the character from one camera, cut to what any of them covers.

    Parameters
    ----------
    take : layer_take.LayerTake
    shapes : (N, V, 3) float array [character's unit]
    aspect : width of a picture by its height
    colours : (N, V, 3) float array in 0..1, optional
        In place of the character's own.
    """
    character = take.character
    painted = []
    for row, shape in enumerate(shapes):
        paint = portrait.painter(
            character.neutral,
            polygons.triangulate(character.sizes, character.corners),
            character.colours if colours is None else colours[row],
            head_transform.face_axes(character.up_axis),
            (shapes.min(axis=(0, 1)), shapes.max(axis=(0, 1))),
            SIDE,
        )
        painted.append(paint(shape))
    covered = np.zeros((SIDE, SIDE), bool)
    for picture in painted:
        covered |= np.abs(picture.astype(int) - picture[:, :1]).max(axis=2) > EMPTY
    rows, columns = np.nonzero(covered)
    left, top, right, bottom = window(
        (columns.min(), rows.min()), (columns.max(), rows.max()), aspect, (SIDE, SIDE)
    )
    return [picture[top:bottom, left:right] for picture in painted]


def of_film(
    show: Path, take: layer_take.LayerTake, frames: list[int], points: np.ndarray, aspect: float
) -> tuple[list[np.ndarray], np.ndarray]:
    """Return the film at frames of the layers' clock, cut to the face, and points (N, P, 2) in it.

    Parameters
    ----------
    show : Path
    take : layer_take.LayerTake
    frames : list of int
    points : (N, P, 2) float array [px]
        What the pictures have to show.
    aspect : width of a picture by its height
    """
    path = layer_take.film_path(show)
    rate = film.nominal_rate(path)
    numbers = [int(frame / take.solved.rate * rate) for frame in frames]
    found = film.frames_at(path, numbers, layer_take.simplices_path(show))
    low, high = np.nanmin(points, axis=(0, 1)), np.nanmax(points, axis=(0, 1))
    low = low - (0.0, HAIR * (high - low)[1])
    tall, wide = found[numbers[0]].shape[:2]
    left, top, right, bottom = window(low, high, aspect, (wide, tall))
    pictures = [found[number][top:bottom, left:right] for number in numbers]
    return pictures, points - (left, top)


def window(low, high, aspect, size) -> tuple[int, int, int, int]:
    """Return left, top, right and bottom of the cut of an aspect about a box, within a picture.

    Parameters
    ----------
    low, high : (2,) of the box [px]
    aspect : width by height
    size : width and height of the picture [px]
    """
    low, high = np.asarray(low, float), np.asarray(high, float)
    middle, reach = (low + high) / 2, (1 + 2 * MARGIN) * (high - low)
    wide = min(max(reach[0], reach[1] * aspect), size[0], size[1] * aspect)
    reach = np.array([wide, wide / aspect])
    start = np.clip(middle - reach / 2, 0, np.maximum(size - reach, 0))
    left, top = np.rint(start).astype(int)
    right, bottom = np.rint(start + reach).astype(int)
    return left, top, min(right, size[0]), min(bottom, size[1])
