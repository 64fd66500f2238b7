"""`simplices.npz`: the extremes that an actor and a character share, ready to be solved for.

Arrays: `basis` (D, K), `scale` (D,), `masks` (R, D), `layer` (K,), `gaps` (K,), `gap_weights`
(D,). The header: `layers` (J),
`extremes` (K pairs of layer and name), `masks` (R names), `points` (groups of kind and names),
`driven_by` (`video`, `markers` or `both`), `lip_points`, `lip_mask`, `closed_gap`, `gap_start`.
Beside it lies a table of what became of each extreme and point, `layer, name, state, detail`.
"""

import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from stages.files import delimited, errors, extremes, layer_points, model

KIND = "simplices"
ARRAYS = ("basis", "scale", "layer", "gaps", "gap_weights")
USED, LEFT_OUT = "used", "left out"
REPORT = ("layer", "name", "state", "detail")


@dataclasses.dataclass(frozen=True)
class Simplices:
    """The extremes of J layers that actor and character share.

    Attributes
    ----------
    layers : J names
    extremes : layer and name of each of the K extremes
    masks : R names
    layout : groups of points, D coordinates in all
    driven_by : `video`, `markers` or `both`
    basis : (D, K) float array [face units], the actor's extremes less the neutral
    scale : (D,) float array [1 / face unit], by which coordinates are balanced
    mask_weights : (R, D) float array, one in sum at every coordinate
    layer : (K,) int array, the layer of each extreme
    lip_points : `upper,lower`, whose distance shows lip closures; or an empty text
    lip_mask : the mask of the lips; an empty text where there is no lip bias
    closed_gap : that distance [face units] where the lips are closed; NaN without a lip bias
    gaps : (K,) float array [face units], how far the lips of each extreme are open, on the
        character if it shows where its lips meet; zero without a lip bias
    gap_weights : (D,) float array [face units by balanced offsets], what tells the distance of the
        lips less `closed_gap`; zero where nothing does
    gap_start : that distance [face units] at the neutral
    """

    layers: list[str]
    extremes: list[tuple[str, str]]
    masks: list[str]
    layout: layer_points.Layout
    driven_by: str
    basis: np.ndarray
    scale: np.ndarray
    mask_weights: np.ndarray
    layer: np.ndarray
    lip_points: str
    lip_mask: str
    closed_gap: float
    gaps: np.ndarray
    gap_weights: np.ndarray
    gap_start: float


def write(path: str | Path, made: Simplices, meta: dict, sources: Iterable[str | Path]) -> None:
    """Write simplices, and what else the file says of itself."""
    arrays = {name: getattr(made, name) for name in ARRAYS}
    header = {
        "layers": made.layers,
        "extremes": [list(extreme) for extreme in made.extremes],
        "masks": made.masks,
        "points": [{"kind": group.kind, "names": group.names} for group in made.layout],
        "driven_by": made.driven_by,
        "lip_points": made.lip_points,
        "lip_mask": made.lip_mask,
        "closed_gap": None if np.isnan(made.closed_gap) else made.closed_gap,
        "gap_start": made.gap_start,
        "units": "face units",
    }
    model.write(path, KIND, arrays | {"masks": made.mask_weights}, header | meta, sources)


def read(path: str | Path) -> Simplices:
    """Read simplices.

    Raises
    ------
    errors.InputError
        if the file is of another kind
    """
    arrays, header = model.read(path, KIND)
    for name in ARRAYS:
        if name not in arrays:
            raise errors.InputError(path, f"holds no {name}: delete it and run again")
    closed_gap = header["closed_gap"]
    return Simplices(
        header["layers"],
        [(layer, name) for layer, name in header["extremes"]],
        header["masks"],
        [layer_points.Group(group["kind"], group["names"]) for group in header["points"]],
        header["driven_by"],
        arrays["basis"],
        arrays["scale"],
        arrays["masks"],
        arrays["layer"],
        header["lip_points"],
        header["lip_mask"],
        np.nan if closed_gap is None else closed_gap,
        arrays["gaps"],
        arrays["gap_weights"],
        header["gap_start"],
    )


def lip_indices(made: Simplices) -> tuple[int, int, int]:
    """Return mask, layer and extreme of the lip bias as indices; -1 each where there is none."""
    if not made.lip_mask:
        return -1, -1, -1
    speech = made.layers.index(extremes.CLOSED_LIPS[0])
    return made.masks.index(made.lip_mask), speech, made.extremes.index(extremes.CLOSED_LIPS)


def check_lips(path: str | Path, made: Simplices, lip_points: str, lip_mask: str) -> None:
    """Refuse simplices that were made for other lips than a solve asks for."""
    if (made.lip_points, made.lip_mask) != (lip_points, lip_mask):
        was = f"was made for lip points '{made.lip_points}' and lip mask '{made.lip_mask}'"
        message = f"{was}, not '{lip_points}' and '{lip_mask}'"
        raise errors.InputError(path, f"{message}: run assemble_simplices again")


def write_report(path: str | Path, rows: Sequence[tuple[str, str, str, str]]) -> None:
    """Write what became of each extreme and point."""
    delimited.write(path, REPORT, rows)
