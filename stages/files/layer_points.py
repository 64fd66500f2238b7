"""The points of a shot that drive layers: markers, points of the film, or both, as offsets.

Markers have three coordinates and points of the film two; each kind is its own group, aligned by
itself (K11 section 4). A layout names the points of every group, and so the D coordinates of all:
groups one after another, in a group point by point.
"""

import dataclasses
from collections.abc import Iterable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stages.files import driving_points, errors, series

KINDS = {"video": ("video",), "markers": ("markers",), "both": ("markers", "video")}


class Group(NamedTuple):
    """Points of one kind: `markers` or `video`, and their names."""

    kind: str
    names: list[str]

    @property
    def dimensions(self) -> int:
        """Return how many coordinates a point has."""
        return len(driving_points.AXES[self.kind])


Layout = Sequence[Group]


@dataclasses.dataclass(frozen=True)
class LayerPoints:
    """What is known of the points on every frame.

    Attributes
    ----------
    frame : (T,) int array
    time_s : (T,) float array [s]
    rate : frames per second
    layout : its groups
    offsets : a (T, P, D) float array [face units] for each group, differences from the shot's
        neutral, NaN where not observed
    neutrals : its (P, D) float array [face units] for each group
    confidence : (T,) float array, 0..1, mean of the groups', by their numbers of coordinates
    """

    frame: np.ndarray
    time_s: np.ndarray
    rate: Fraction
    layout: Layout
    offsets: list[np.ndarray]
    neutrals: list[np.ndarray]
    confidence: np.ndarray


def read(path: str | Path, points: str) -> LayerPoints:
    """Read the `markers`, the `video` points, or `both`, of an expression.

    Raises
    ------
    errors.InputError
        if the shot lacks a kind that is wanted
    """
    groups = [(kind, driving_points.read(path, kind)) for kind in KINDS[points]]
    first = groups[0][1]
    confidence = np.stack([np.nan_to_num(driving.confidence) for _, driving in groups])
    counts = [driving.neutral.size for _, driving in groups]
    return LayerPoints(
        first.frame,
        first.time_s,
        first.rate,
        [Group(kind, driving.names) for kind, driving in groups],
        [driving.points - driving.neutral for _, driving in groups],
        [driving.neutral for _, driving in groups],
        np.average(confidence, axis=0, weights=counts),
    )


def read_available(path: str | Path, points: str) -> LayerPoints:
    """Read of the points that are wanted those that the shot has.

    Raises
    ------
    errors.InputError
        if it has none
    """
    meta = series.read(path, "expression").meta
    own = {"markers": bool(meta.get("markers")), "video": bool(meta.get("points"))}
    kinds = [kind for kind in KINDS[points] if own[kind]]
    return read(path, kinds[0] if len(kinds) == 1 else points)


def known_names(path: str | Path) -> list[str]:
    """Return the names of all points of an expression, of either kind."""
    meta = series.read(path, "expression").meta
    return [*meta.get("points", []), *meta.get("markers", [])]


def joined(layouts: Iterable[Layout]) -> list[Group]:
    """Return the layout that holds every point of several with the same kinds."""
    names: dict[str, dict[str, None]] = {}
    for layout in layouts:
        for group in layout:
            names.setdefault(group.kind, {}).update(dict.fromkeys(group.names))
    return [Group(kind, list(own)) for kind, own in names.items()]


def flat(points: LayerPoints, layout: Layout) -> np.ndarray:
    """Return (T, D) offsets in the order of a layout, NaN for points that the shot lacks."""
    columns = []
    for group in layout:
        values = np.full((len(points.frame), len(group.names), group.dimensions), np.nan)
        for own, offsets in zip(points.layout, points.offsets, strict=True):
            if own.kind == group.kind:
                index = {name: place for place, name in enumerate(own.names)}
                shared = [place for place, name in enumerate(group.names) if name in index]
                values[:, shared] = offsets[:, [index[group.names[place]] for place in shared]]
        columns.append(values.reshape(len(values), -1))
    return np.concatenate(columns, axis=1)


def point_of(layout: Layout) -> np.ndarray:
    """Return the point (D,) of every coordinate, counted over all groups."""
    dimensions = [group.dimensions for group in layout for _ in group.names]
    return np.repeat(np.arange(len(dimensions)), dimensions)


def group_of(layout: Layout) -> np.ndarray:
    """Return the group (D,) of every coordinate."""
    counts = [len(group.names) * group.dimensions for group in layout]
    return np.repeat(np.arange(len(counts)), counts)


def point_names(layout: Layout) -> list[str]:
    """Return the names of all points, group after group."""
    return [name for group in layout for name in group.names]


def without(layout: Layout, left_out: Sequence[int]) -> list[Group]:
    """Return a layout without some of its points, counted over all groups."""
    kept, first = [], 0
    for group in layout:
        own = [name for i, name in enumerate(group.names, first) if i not in left_out]
        kept.append(Group(group.kind, own))
        first += len(group.names)
    return [group for group in kept if group.names]


def coordinates_of(layout: Layout, part: Layout) -> np.ndarray:
    """Return which coordinates (D,) of a layout are those of a part of it."""
    own = {(group.kind, name) for group in part for name in group.names}
    kept = [(group.kind, name) in own for group in layout for name in group.names]
    return np.array(kept, bool)[point_of(layout)]


def check_within(path: str | Path, points: LayerPoints, layout: Layout) -> list[str]:
    """Return the points of a layout that a shot lacks, and refuse one that lacks most.

    Raises
    ------
    errors.InputError
        if more than half are missing
    """
    own = set(point_names(points.layout))
    wanted = point_names(layout)
    missing = [name for name in wanted if name not in own]
    if 2 * len(missing) > len(wanted):
        message = f"{len(missing)} of the {len(wanted)} points of the extremes are missing"
        cure = "name them as in the basis shots"
        raise errors.InputError(path, f"{message}, the first is {missing[0]}: {cure}")
    return missing
