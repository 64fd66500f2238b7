"""`layers.parquet`: what each frame of a take holds of emotion, speech and blink (K11 section 4).

Columns: `weight.<mask>.<layer>`, how much a layer has to say in a mask, one in sum over the layers;
`coefficient.<layer>.<name>`, how much of each extreme, one in sum over a layer;
`amplitude.<mask>`, what all layers in a mask are multiplied by, 1 unless they may go beyond one in
sum; and the measures of `MEASURES` with `confidence`. NaN where too little was observed. Layers and
extremes that actor and character do not share have no columns.
"""

import dataclasses
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import errors, series

KIND = "layers"
MEASURES = {
    "residual": "face units, root mean square per coordinate",
    "outside": "distance from the simplices, 1 is the length of a mean extreme",
    "objective": "1 is standing still at a mean extreme",
    "gap": "objective less its lower bound; 1 is standing still at a mean extreme",
    "lip_bias": "0 to 1, how nearly closed the lips are",
}


@dataclasses.dataclass(frozen=True)
class Layers:
    """The layers of a take.

    Attributes
    ----------
    frame : (T,) int array
    time_s : (T,) float array [s]
    rate : frames per second
    masks : R names
    layers : J names
    extremes : layer and name of each of the K extremes
    weights : (T, R, J) float array
    coefficients : (T, K) float array
    amplitudes : (T, R) float array
    measures : name -> (T,) float array, those of `MEASURES`
    confidence : (T,) float array, 0..1
    """

    frame: np.ndarray
    time_s: np.ndarray
    rate: Fraction
    masks: list[str]
    layers: list[str]
    extremes: list[tuple[str, str]]
    weights: np.ndarray
    coefficients: np.ndarray
    amplitudes: np.ndarray
    measures: dict[str, np.ndarray]
    confidence: np.ndarray


def write(path: str | Path, layers: Layers, meta: dict, sources: Iterable[str | Path]) -> None:
    """Write the layers of a take, and what else the file says of itself."""
    names = _weight_columns(layers.masks, layers.layers)
    columns = dict(zip(names, layers.weights.reshape(len(layers.frame), -1).T, strict=True))
    names = _coefficient_columns(layers.extremes)
    columns |= dict(zip(names, layers.coefficients.T, strict=True))
    columns |= dict(zip(_amplitude_columns(layers.masks), layers.amplitudes.T, strict=True))
    columns |= {name: layers.measures[name] for name in MEASURES}
    columns["confidence"] = layers.confidence
    header = {
        "masks": layers.masks,
        "layers": layers.layers,
        "extremes": [list(extreme) for extreme in layers.extremes],
        "units": MEASURES,
    }
    series.write(
        path, KIND, layers.frame, layers.time_s, columns, layers.rate, header | meta, sources
    )


def read(path: str | Path) -> Layers:
    """Read the layers of a take.

    Raises
    ------
    errors.InputError
        if the file is of another kind, or a column is missing
    """
    found = series.read(path, KIND)
    masks, layers = found.meta["masks"], found.meta["layers"]
    extremes = [(layer, name) for layer, name in found.meta["extremes"]]
    weights = _stack(found, path, _weight_columns(masks, layers))
    return Layers(
        found.frame,
        found.time_s,
        found.rate,
        masks,
        layers,
        extremes,
        weights.reshape(len(found.frame), len(masks), len(layers)),
        _stack(found, path, _coefficient_columns(extremes)),
        _stack(found, path, _amplitude_columns(masks)),
        {name: _stack(found, path, [name])[:, 0] for name in MEASURES},
        _stack(found, path, ["confidence"])[:, 0],
    )


def _weight_columns(masks: list[str], layers: list[str]) -> list[str]:
    """Return the columns of the weights, layers running fastest."""
    return [f"weight.{mask}.{layer}" for mask in masks for layer in layers]


def _coefficient_columns(extremes: list[tuple[str, str]]) -> list[str]:
    """Return the columns of the coefficients."""
    return [f"coefficient.{layer}.{name}" for layer, name in extremes]


def _amplitude_columns(masks: list[str]) -> list[str]:
    """Return the columns of the amplitudes."""
    return [f"amplitude.{mask}" for mask in masks]


def _stack(found: series.Series, path: str | Path, names: list[str]) -> np.ndarray:
    """Return the values (T, N) of columns."""
    for name in names:
        if name not in found.columns:
            raise errors.InputError(path, f"column {name} is missing: delete it and run again")
    return np.stack([found.columns[name] for name in names], axis=1)
