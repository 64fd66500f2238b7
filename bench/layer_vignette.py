"""The example's vignette for trials of layers: points, truth, solutions, what they make of rigs.

Everything is read from a finished show. `Take.solve` solves as the stage does, with whatever
settings a trial asks for, and keeps what it has solved.
"""

import dataclasses
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stages.core import (
    coordinate_balance,
    layer_composition,
    layer_model,
    layer_solver,
    lip_closeness,
    lip_estimate,
)
from stages.files import layer_points, lip_gap, simplices

SHOT, ACTOR = "vignette", "mia"
CHARACTERS = ("clay_layers", "tortoise", "globe", "cassette")
LIP_MARKERS, UNIT_MARKERS = "MULP,MLLP", ("RECO", "LECO")


class How(NamedTuple):
    """Say how layers are solved, as characters.tsv does, which points are seen, and for whom."""

    lip_sigma: float = 0.02
    temporal: float = 0.05
    beyond: float = 0.0
    balance: str = "mask_variance"
    points: str = "both"
    lip_bias: str = "mouth"
    lean: float = 0.01
    lips: str = "film"
    character: str = CHARACTERS[0]


# as characters.tsv has it where nothing else is asked for
DEFAULT = How(lip_sigma=0.012, beyond=0.5, lip_bias="gap", lips="told")


class Solved(NamedTuple):
    """Hold weights (T, R, J), coefficients (T, K), amplitudes (T, R), u (T, R, K), gamma (T,)."""

    weights: np.ndarray
    coefficients: np.ndarray
    amplitudes: np.ndarray
    u: np.ndarray
    gamma: np.ndarray


@dataclasses.dataclass
class Take:
    """Hold the vignette as it was measured, and as it was planted.

    Attributes
    ----------
    show : folder of the show
    made : what actor and characters share; all characters of the example share the same
    offsets : (T, D) float array [face units]
    gaps : of the lips by `film`, `markers`, `either`, `told` by all about them, or `truth`, less
        that of closed ones, (T,) float arrays [face units]
    opened : character -> (K,) float array, how far its extremes' lips are open [face units]
    rate : frames per second
    truth : what the generator knows, by name
    lips_apart : (2,) float array [face units], from the lower lip to the upper in the neutral
    planted : (T, R, K) float array, strengths of the layers times coefficients
    kept : solutions by how they were found
    """

    show: Path
    made: simplices.Simplices
    offsets: np.ndarray
    gaps: dict
    opened: dict
    rate: float
    truth: dict
    lips_apart: np.ndarray
    planted: np.ndarray
    kept: dict = dataclasses.field(default_factory=dict)

    def solve(self, how: How) -> Solved:
        """Return the layers of the vignette."""
        if how not in self.kept:
            made = dataclasses.replace(self.made, gaps=self.opened[how.character])
            self.kept[how] = solve(made, self.offsets, self.gaps[how.lips], self.rate, how)
        return self.kept[how]

    def fresh(self, made: simplices.Simplices) -> None:
        """Refuse a character whose extremes are others."""
        if made.extremes != self.made.extremes or not np.array_equal(made.basis, self.made.basis):
            raise ValueError("the characters of the example no longer share the same extremes")


def read(show: Path) -> Take:
    """Read the vignette of a finished show."""
    cast = show / "results/cast" / ACTOR
    made = simplices.read(cast / CHARACTERS[0] / "simplices.npz")
    path = show / "results/shots" / SHOT / "expression.parquet"
    points = layer_points.read(path, made.driven_by)
    truth = dict(np.load(show / "data_example/truth" / f"{SHOT}.npz"))
    count = len(points.frame)
    truth = {name: v[:count] if len(v) == count + 1 else v for name, v in truth.items()}
    offsets = layer_points.flat(points, made.layout)
    told = lip_estimate.Estimate(made.gap_weights, made.gap_start)
    take = Take(
        show,
        made,
        offsets,
        _gaps(show, made, truth) | {"told": lip_estimate.gap(told, offsets * made.scale)},
        {CHARACTERS[0]: made.gaps},
        float(points.rate),
        truth,
        _lips_apart(made, points),
        np.zeros(0),
    )
    take.planted = planted(take)
    for name in CHARACTERS[1:]:
        other = simplices.read(cast / name / "simplices.npz")
        take.fresh(other)
        take.opened[name] = other.gaps
    return take


def _lips_apart(made: simplices.Simplices, points: layer_points.LayerPoints) -> np.ndarray:
    """Return the way from the lower lip to the upper one on the neutral film (2,)."""
    film = [each.kind for each in points.layout].index("video")
    names = points.layout[film].names
    upper, lower = (
        points.neutrals[film][names.index(n)] for n in made.lip_points.split(";")[0].split(",")
    )
    return upper - lower


def _gaps(show: Path, made: simplices.Simplices, truth: dict) -> dict[str, np.ndarray]:
    """Return how far the lips stand apart, less the gap of closed ones, by what shows it."""
    shots = show / "results/shots"
    path, basis = shots / SHOT / "expression.parquet", shots / "faces/expression.parquet"
    frames = [layer_points.read(each, "video").frame for each in (path, basis)]
    names = list(truth["extreme_names"])
    closed = int(truth["extreme_frame"][names.index("speech_m")])
    found = {"film": lip_gap.read(path, made.lip_points, frames[0]) - made.closed_gap}
    seen, still = (
        lip_gap.read(each, LIP_MARKERS, frame)
        for each, frame in zip((path, basis), frames, strict=True)
    )
    found["markers"] = seen - still[closed]
    # the film's face unit in mm: what explains its gap
    known = np.isfinite(found["film"])
    opening = truth["opening_mm"].astype(float)
    unit = (opening[known] @ opening[known]) / (opening[known] @ found["film"][known])
    # markers have a larger face unit; lips that either shows closed are closed
    ends = [truth["marker_neutral"][list(truth["marker_names"]).index(n)] for n in UNIT_MARKERS]
    by_markers = found["markers"] * np.linalg.norm(ends[1] - ends[0]) / unit
    either = np.fmin(found["film"], by_markers)
    return found | {"truth": opening / unit, "either": either}


def planted(take: Take) -> np.ndarray:
    """Return what the generator planted, strength times coefficient (T, R, K)."""
    truth, made = take.truth, take.made
    names = list(truth["extreme_names"])
    order = [names.index("_".join(extreme)) for extreme in made.extremes]
    masks = [list(truth["mask_names"]).index(name) for name in made.masks]
    layers = [list(truth["layer_names"]).index(name) for name in made.layers]
    strength = truth["strength"].astype(float)[:, masks][:, :, layers]
    coefficient = truth["coefficient"].astype(float)[:, order]
    return strength[:, :, made.layer] * coefficient[:, None]


def solve(
    made: simplices.Simplices, offsets: np.ndarray, gap: np.ndarray, rate: float, how: How
) -> Solved:
    """Solve offsets (T, D) as the stage does; the gap (T,) of the lips is less that of closed."""
    own = coordinates(made, how.points)
    numbers = np.unique(layer_points.group_of(made.layout)[own], return_inverse=True)[1]
    basis, masks = made.basis[own], made.mask_weights[:, own]
    scale = coordinate_balance.factors(basis, numbers, masks, how.balance)
    gamma = np.zeros(len(offsets))
    if how.lip_sigma > 0:
        rule = lip_closeness.steep if how.lip_bias == "gap" else lip_closeness.closeness
        gamma = rule(gap, 0.0, how.lip_sigma)
    lips = simplices.lip_indices(made) if gamma.any() else (-1, -1, -1)
    opened = made.gaps if gamma.any() else None
    model = layer_model.build(basis * scale[:, None], made.layer, masks, *lips, opened)
    temporal = layer_solver.temporal_at(rate, how.temporal)
    settings = layer_solver.Settings(temporal, how.beyond, how.lip_bias, how.lean)
    found = layer_solver.solve(model, settings, offsets[:, own] * scale, gamma)
    u = layer_composition.displacements(
        made.layer, found.weights, found.coefficients, found.amplitudes
    )
    return Solved(found.weights, found.coefficients, found.amplitudes, u, gamma)


def coordinates(made: simplices.Simplices, points: str) -> np.ndarray:
    """Return which coordinates (D,) belong to `markers`, `video` or `both`."""
    kinds = np.array([each.kind for each in made.layout])
    return np.isin(kinds[layer_points.group_of(made.layout)], layer_points.KINDS[points])


def lone(take: Take, extreme: tuple[str, str]) -> np.ndarray:
    """Return the displacements (1, R, K) of one extreme in full on the whole face."""
    u = np.zeros((1, *take.planted.shape[1:]))
    u[0, :, take.made.extremes.index(extreme)] = 1.0
    return u


def lip_gap_of(take: Take, offsets: np.ndarray) -> np.ndarray:
    """Return the gap (T,) of the lips on the film, less that of closed ones, of offsets (T, D)."""
    upper, lower = take.made.lip_points.split(";")[0].split(",")
    names = layer_points.point_names(take.made.layout)
    point_of = layer_points.point_of(take.made.layout)
    at = [np.flatnonzero(point_of == names.index(name)) for name in (upper, lower)]
    between = take.lips_apart + offsets[:, at[0]] - offsets[:, at[1]]
    return np.linalg.norm(between, axis=1) - take.made.closed_gap


def talking(take: Take) -> np.ndarray:
    """Return on which frames (T,) she talks: the planted strength of speech in the mouth."""
    mouth = list(take.truth["mask_names"]).index("mouth")
    speech = list(take.truth["layer_names"]).index("speech")
    return take.truth["strength"][:, mouth, speech].astype(float) > 0.5


def row(label: str, cells, width: int = 9, digits: int = 3, first: int = 34) -> str:
    """Return a line of a table."""
    text = "".join(
        f"{cell:>{width}}" if isinstance(cell, str) else f"{cell:>{width}.{digits}f}"
        for cell in cells
    )
    return f"{label:{first}}{text}"
