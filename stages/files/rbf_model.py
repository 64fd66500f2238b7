"""`rbf.npz`: what was learnt from tuned pairs, ready to predict weights.

Arrays: the actor's axes `mean` (P D,), `components` (C, P D), `variance` (C,); the regression
`constant` (K,), `linear` (L, K), `centres` (N, R), `weights` (N, K), `lambdas` (K,); `examples`
(N, C), the pairs on the axes. The header: `points` (`markers` or `video`) and their `point_names`,
`shapes` (K names `<mask>.<shape>`), `method`, `dimensions`, `noise`, `width` and `spacing`, the
median distance of an example from the nearest other. Coordinates are face units, differences from
the neutral of the shot's session.
"""

import dataclasses
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from stages.core import pca, weight_regression
from stages.files import model

KIND = "rbf"
ARRAYS = ("constant", "linear", "centres", "weights", "lambdas")


@dataclasses.dataclass(frozen=True)
class RbfModel:
    """Axes of an actor's points and a regression to the weights of a rig.

    Attributes
    ----------
    points : `markers` or `video`
    point_names : the P points
    shapes : the K shapes, `<mask>.<shape>`
    axes : of the points' differences from the neutral [face units]
    noise : variance of a coordinate off the axes [face units squared]
    regression : from coordinates on the axes to weights
    examples : (N, C) float array, the pairs' coordinates
    spacing : median distance of an example from the nearest other [face units]
    header : how the regression was chosen; JSON
    """

    points: str
    point_names: list[str]
    shapes: list[str]
    axes: pca.Pca
    noise: float
    regression: weight_regression.Regression
    examples: np.ndarray
    spacing: float
    header: dict


def write(path: str | Path, trained: RbfModel, sources: Iterable[str | Path] = ()) -> None:
    """Write a model."""
    arrays = trained.axes._asdict() | {"examples": trained.examples}
    arrays |= {name: getattr(trained.regression, name) for name in ARRAYS}
    header = trained.header | {
        name: getattr(trained, name)
        for name in ("points", "point_names", "shapes", "noise", "spacing")
    }
    model.write(path, KIND, arrays, header | {"width": trained.regression.width}, sources)


def read(path: str | Path) -> RbfModel:
    """Read a model.

    Raises
    ------
    errors.InputError
        if the file is of another kind
    """
    arrays, header = model.read(path, KIND)
    return RbfModel(
        header["points"],
        header["point_names"],
        header["shapes"],
        pca.Pca(arrays["mean"], arrays["components"], arrays["variance"]),
        header["noise"],
        weight_regression.Regression(
            **{name: arrays[name] for name in ARRAYS}, width=header["width"]
        ),
        arrays["examples"],
        header["spacing"],
        header,
    )
