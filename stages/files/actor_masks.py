"""`actor_masks.tsv`: which of an actor's points belong to which mask (K11 section 3.2).

Columns: actor, mask, point, weight. A point is one of the film, a marker, or a contour, which
stands for all its points; a row that names a point overrides its contour's. A blank weight is 1.
One mask may have `*`: the points that no row lists, and what is left to one at those that others
list. The weights of every point sum to one. A point whose rows all say 0 is not used: brows of a
film on a head that nods, say, where markers see them better.
"""

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stages.files import delimited, errors, point_set

COLUMNS = ("actor", "mask", "point")
OTHERS = "*"
SHOWN = 5  # points that an error names
CLOSE = 1e-3  # of one, that a sum may be off


class ActorMasks(NamedTuple):
    """Hold R masks of P points, in the table's order.

    Attributes
    ----------
    names : the masks
    weights : (R, P) float array, one in sum at every point, 0 at those that are not used
    """

    names: list[str]
    weights: np.ndarray


def read(path: str | Path, actor: str, points: Sequence[str], known: Collection[str]) -> ActorMasks:
    """Read the masks of an actor.

    Parameters
    ----------
    path : the table
    actor : whose rows
    points : the P points that are wanted
    known : all points of the actor; rows may name those that are not wanted too

    Raises
    ------
    errors.InputError
        if the actor has no row, a row names no point, two rows are the same, points are left out,
        the weights of a point do not sum to one, or a mask has no point
    """
    rows = _rows(path, actor, {*known, *points})
    names = list(dict.fromkeys(mask for mask, _ in rows))
    weights = np.full((len(names), len(points)), np.nan)
    contours = np.array([point_set.contour_of(point) for point in points])
    for (mask, name), weight in sorted(rows.items(), key=lambda row: row[0][1] in points):
        weights[names.index(mask), (np.array(points) == name) | (contours == name)] = weight
    rest = [mask for mask, name in rows if name == OTHERS]
    if len(rest) > 1:
        message = f"{OTHERS} stands in {' and '.join(rest)} of {actor}: leave it to one mask"
        raise errors.InputError(path, message)
    for mask in rest:
        own = np.isnan(weights[names.index(mask)]) & ~_refused(weights)
        others = np.nansum(np.delete(weights, names.index(mask), axis=0), axis=0)
        weights[names.index(mask), own] = np.maximum(1 - others[own], 0.0)
    refused = _refused(weights)
    weights = np.nan_to_num(weights)
    kept = [point for point, out in zip(points, refused, strict=True) if not out]
    _check(path, actor, names, kept, weights[:, ~refused])
    return ActorMasks(names, weights / np.where(refused, 1.0, weights.sum(axis=0)))


def _refused(weights: np.ndarray) -> np.ndarray:
    """Return the points (P,) whose rows all say 0, of weights with NaN where there is no row."""
    return np.any(weights == 0, axis=0) & ~np.any(weights > 0, axis=0)


def _rows(path: str | Path, actor: str, known: Collection[str]) -> dict[tuple[str, str], float]:
    """Return the weights of an actor by mask and point, contour or `*`."""
    spelt = {*known, *map(point_set.contour_of, known), OTHERS}
    found: dict[tuple[str, str], float] = {}
    for row in delimited.read(path, COLUMNS, ["weight"]):
        if row.cells["actor"] != actor:
            continue
        mask, name = row.cells["mask"], row.cells["point"]
        if name not in spelt:
            message = f"line {row.line}, column point: {actor} has no point, marker or contour"
            raise errors.InputError(path, f"{message} '{name}': correct or remove it")
        if (mask, name) in found:
            message = f"line {row.line}: {name} stands twice in mask {mask}"
            raise errors.InputError(path, f"{message}: remove one")
        weight = delimited.number(path, row, "weight") if row.cells.get("weight") else 1.0
        if not 0 <= weight <= 1:
            message = f"line {row.line}, column weight: {weight:g} is not within 0 and 1"
            raise errors.InputError(path, f"{message}: write the mask's share in the point")
        found[mask, name] = weight
    if not found:
        message = f"has no row for actor {actor}: say which points belong to which mask"
        raise errors.InputError(path, f"{message}, the last mask may have the point {OTHERS}")
    return found


def _check(
    path: str | Path, actor: str, names: Sequence[str], points: Sequence[str], weights: np.ndarray
) -> None:
    """Refuse masks that are no partition of the points, or one that has none."""
    for mask, own in zip(names, weights, strict=True):
        if not own.any():
            message = f"mask {mask} of {actor} has none of the {len(points)} points that drive"
            raise errors.InputError(path, f"{message}: give it points, or see points in cast.tsv")
    sums = weights.sum(axis=0)
    left_out = [point for point, total in zip(points, sums, strict=True) if total == 0]
    if left_out:
        named = ", ".join(left_out[:SHOWN]) + (", …" if len(left_out) > SHOWN else "")
        message = f"the masks of {actor} leave {len(left_out)} points out, {named}"
        raise errors.InputError(path, f"{message}: list them, or give one mask the point {OTHERS}")
    worst = int(np.abs(sums - 1).argmax())
    if abs(sums[worst] - 1) > CLOSE:
        shares = [
            f"{mask} {share:g}"
            for mask, share in zip(names, weights[:, worst], strict=True)
            if share
        ]
        message = f"the masks of {actor} sum to {sums[worst]:g} at {points[worst]}"
        raise errors.InputError(path, f"{message} ({', '.join(shares)}): make it 1")


def check_names(path: str | Path, actor: str, masks: Sequence[str], own: Sequence[str]) -> None:
    """Refuse masks that the character does not have, or lacks.

    Raises
    ------
    errors.InputError
        naming the first
    """
    for name in [*masks, *own]:
        if name not in own:
            message = f"the character has no mask '{name}', its masks are {', '.join(own)}"
            raise errors.InputError(path, f"{message}: use the same names")
        if name not in masks:
            message = f"lacks the character's mask '{name}' for actor {actor}"
            raise errors.InputError(path, f"{message}: give it points")
