"""How far the layered model and each layer alone stay from the actor's frames (K11 figure 8)."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench.figures import example, layer_take
from stages.core import layer_composition, layer_model, layer_solver, simplex_least_squares
from stages.files import layer_points, layers, series, simplices

LAYERED, DELIVERED = "layered", "layered, as delivered"
UNIT_MARKERS = ("RECO", "LECO")


class Errors(NamedTuple):
    """Hold the errors of a shot.

    Attributes
    ----------
    time_s : (T,) float array [s]
    of_kind : kind of point -> way -> (T,) float array
        Root mean square distance of the points that were seen, `markers` in mm and `video` in
        face units.
    under : mask -> way -> (T,) float array [mm]
        The same of the markers that mostly belong to a mask.
    """

    time_s: np.ndarray
    of_kind: dict[str, dict[str, np.ndarray]]
    under: dict[str, dict[str, np.ndarray]]


def of_shot(show: Path, shot: str, kinds: Sequence[str] = ("markers", "video")) -> Errors:
    """Solve every frame of a shot in all ways; no bias, nothing that draws to the last frame.

    Parameters
    ----------
    show : Path
    shot : str
    kinds : of the points that are looked at, as far as the shot has them
    """
    made = simplices.read(layer_take.simplices_path(show))
    whole = [group.kind for group in made.layout]
    points = layer_points.read_available(
        example.of_shot(show, shot, "expression.parquet"), made.driven_by
    )
    kinds = [group.kind for group in points.layout if group.kind in kinds]
    made = of_kinds(made, kinds)
    frames = layer_points.flat(points, made.layout)
    rebuilt = {LAYERED: layered(made, frames)}
    taken = example.of_take(show, shot, layer_take.CHARACTER, "layers.parquet")
    if taken.exists() and kinds == whole:
        rebuilt[DELIVERED] = composed(made, layers.read(taken))
    rebuilt |= {name: alone(made, frames, j) for j, name in enumerate(made.layers)}
    wrong = {way: frames - shape for way, shape in rebuilt.items()}
    group_of, unit = layer_points.group_of(made.layout), face_unit_mm(show, shot)
    of_kind, under = {}, {}
    for number, group in enumerate(made.layout):
        own = group_of == number
        size = unit if group.kind == "markers" else 1.0
        of_kind[group.kind] = {
            way: size * distance(left[:, own], group.dimensions) for way, left in wrong.items()
        }
        if group.kind == "markers":
            for mask, weights in zip(made.masks, made.mask_weights, strict=True):
                parts = own & (weights > 0.5)
                under[mask] = {
                    way: unit * distance(left[:, parts], group.dimensions)
                    for way, left in wrong.items()
                }
    return Errors(points.time_s, of_kind, under)


def of_kinds(made: simplices.Simplices, kinds: Sequence[str]) -> simplices.Simplices:
    """Return simplices of some kinds of points only."""
    groups = [number for number, group in enumerate(made.layout) if group.kind in kinds]
    kept = np.isin(layer_points.group_of(made.layout), groups)
    return dataclasses.replace(
        made,
        layout=[made.layout[number] for number in groups],
        basis=made.basis[kept],
        scale=made.scale[kept],
        mask_weights=made.mask_weights[:, kept],
    )


def layered(made: simplices.Simplices, frames: np.ndarray) -> np.ndarray:
    """Return frames (T, D) as all layers under all masks rebuild them [face units]."""
    model = layer_model.build(made.basis * made.scale[:, None], made.layer, made.mask_weights)
    solution = layer_solver.solve(
        model, layer_solver.Settings(temporal=0.0), frames * made.scale, np.zeros(len(frames))
    )
    return composed(made, solution)


def composed(
    made: simplices.Simplices, solved: layer_solver.Solution | layers.Layers
) -> np.ndarray:
    """Return frames (T, D) as weights, coefficients and amplitudes rebuild them [face units]."""
    u = layer_composition.displacements(
        made.layer, solved.weights, solved.coefficients, solved.amplitudes
    )
    return layer_composition.composed(made.basis, made.mask_weights, u)


def alone(made: simplices.Simplices, frames: np.ndarray, layer: int) -> np.ndarray:
    """Return the points (T, D) of one layer's simplex nearest to frames [face units].

    Nearest by the data term of the layered model, over the coordinates that were observed.
    """
    corners = made.basis[:, made.layer == layer].T
    rebuilt = np.empty_like(frames)
    seen = np.isfinite(frames)
    for pattern in np.unique(seen, axis=0):
        rows = (seen == pattern).all(axis=1)
        scale = made.scale[pattern]
        weights, _ = simplex_least_squares.solve(
            corners[:, pattern] * scale, frames[np.ix_(rows, pattern)] * scale
        )
        rebuilt[rows] = weights @ corners
    return rebuilt


def distance(wrong: np.ndarray, dimensions: int) -> np.ndarray:
    """Return the root mean square length (T,) of errors (T, P * dimensions) of the points seen.

    NaN where none was.
    """
    squares = np.sum(wrong.reshape(len(wrong), -1, dimensions) ** 2, axis=2)
    seen = np.isfinite(squares)
    count = seen.sum(axis=1)
    mean = np.where(seen, squares, 0.0).sum(axis=1) / np.maximum(count, 1)
    return np.where(count > 0, np.sqrt(mean), np.nan)


def face_unit_mm(show: Path, shot: str) -> float:
    """Return the length of the markers' face unit, from two markers before and after alignment."""
    spans = []
    for name in ("performance", "expression"):
        path = example.of_shot(show, shot, f"{name}.parquet")
        right, left = series.stack(series.read(path, name), path, UNIT_MARKERS, "xyz").swapaxes(
            0, 1
        )
        spans.append(np.linalg.norm(right - left, axis=1))
    return float(np.nanmedian(spans[0] / spans[1]))
