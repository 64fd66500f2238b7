"""`expressions.tsv`: the frames that a person picked as an actor's extremes (K11 section 3.1).

Columns: actor, layer, name, shot, frame; the frame counts on the performance's clock. The rows of
one actor are read, those of others are left aside.
"""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from stages.files import delimited, errors, extremes

COLUMNS = ("actor", "layer", "name", "shot", "frame")


class Picked(NamedTuple):
    """A frame that shows an extreme, and the table's line that says so."""

    line: int
    layer: str
    name: str
    shot: str
    frame: int


def read(
    path: str | Path, actor: str, shots: Collection[str], known: Sequence[extremes.Extreme]
) -> list[Picked]:
    """Read the extremes of an actor, in the order of the table of all extremes.

    Parameters
    ----------
    path : the table
    actor : whose rows
    shots : basis shots of the actor
    known : all extremes that there are

    Raises
    ------
    errors.InputError
        naming line and column of a layer, name or shot that does not exist, of an extreme that
        stands twice and of two on one frame; or a layer with a single extreme, or if the actor has
        no row
    """
    order = {(each.layer, each.name): place for place, each in enumerate(known)}
    found: dict[tuple[str, str], Picked] = {}
    taken: dict[tuple[str, str, int], Picked] = {}
    for row in delimited.read(path, COLUMNS):
        if row.cells["actor"] != actor:
            continue
        picked = _picked(path, row, shots, known)
        extreme, place = (picked.layer, picked.name), (picked.layer, picked.shot, picked.frame)
        if extreme in found:
            message = f"line {row.line}: {' '.join(extreme)} stands in line {found[extreme].line}"
            raise errors.InputError(path, f"{message} already: remove one")
        if place in taken:
            both = f"{taken[place].name} and {picked.name} of layer {picked.layer}"
            message = f"line {row.line}: {both} are one frame, {picked.frame} of {picked.shot}"
            raise errors.InputError(path, f"{message}: pick another for one of them")
        found[extreme] = taken[place] = picked
    if not found:
        message = f"has no row for actor {actor}: pick frames that show extremes"
        raise errors.InputError(path, f"{message}, the actor's page of proposals has some")
    rows = [found[extreme] for extreme in sorted(found, key=order.__getitem__)]
    check_layers(path, rows)
    return rows


def check_layers(path: str | Path, rows: Sequence[Picked]) -> None:
    """Refuse a layer with a single extreme, between which and itself nothing lies."""
    for layer in extremes.LAYERS:
        own = [row for row in rows if row.layer == layer]
        if len(own) == 1:
            message = f"line {own[0].line}: {own[0].name} is the one extreme of layer {layer}"
            rest = extremes.AT_REST[layer]
            second = "a second" if own[0].name == rest else f"a second, such as {rest},"
            cure = f"pick {second} or remove the row"
            raise errors.InputError(path, f"{message}: {cure}")


def check_frames(
    path: str | Path, rows: Sequence[Picked], frames: Mapping[str, Collection[int]]
) -> None:
    """Refuse frames that their shot, of those in `frames`, does not have."""
    for row in rows:
        own = frames[row.shot]
        if row.frame not in own:
            known = f"{row.shot} has frames {min(own)} to {max(own)}"
            message = f"line {row.line}, column frame: {known}, not {row.frame}"
            raise errors.InputError(path, f"{message}: write the frame that shows {row.name}")


def _picked(
    path: str | Path,
    row: delimited.Row,
    shots: Collection[str],
    known: Sequence[extremes.Extreme],
) -> Picked:
    """Return a row, once its layer, name and shot are known to exist."""
    layer, name, shot = (row.cells[column] for column in ("layer", "name", "shot"))
    if layer not in extremes.LAYERS:
        message = f"line {row.line}, column layer: '{layer}' is no layer"
        raise errors.InputError(path, f"{message}: write {', '.join(extremes.LAYERS)}")
    if (layer, name) not in {(each.layer, each.name) for each in known}:
        near = extremes.nearest(known, layer, name)
        message = f"line {row.line}, column name: {layer} has no extreme '{name}'"
        raise errors.InputError(path, f"{message}, the nearest is {near}: correct it")
    if shot not in shots:
        known_shots = ", ".join(shots) or "there are none"
        message = f"line {row.line}, column shot: '{shot}' is none of the basis shots that drive"
        raise errors.InputError(path, f"{message} ({known_shots}): see shots.tsv and cast.tsv")
    return Picked(row.line, layer, name, shot, delimited.whole_number(path, row, "frame"))
