"""`directing.tsv`: emotion, speech and blink turned up and down after the solve.

Columns: character, shot (blank: all), layer, name (blank: the whole layer), gain, start_s, end_s
(blank: from the start, to the end; the film's clock), fade_s (blank: 0.2). A name is an extreme, or
a family of emotions, which means all its degrees: `anger` is annoyance, anger and rage. Blends such
as contempt belong to no family. Rows that meet multiply: so anger at 0.5, with annoyance and rage
at 2, halves the middle degree alone.
"""

import dataclasses
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import directing
from stages.files import delimited, errors, extremes

REQUIRED = ("character", "layer", "gain")
OPTIONAL = ("shot", "name", "start_s", "end_s", "fade_s")
FADE_S = 0.2
# beyond this a gain is a slip of the keyboard, and rows that meet could leave single precision
MOST_GAIN = 100.0


@dataclasses.dataclass(frozen=True)
class Row:
    """A row of the table.

    Attributes
    ----------
    line : where it stands
    scope : character, shot, layer and name as written
    extremes : (layer, name) of all extremes that it means
    gain, start_s, end_s, fade_s : as in `directing.Direction`
    """

    line: int
    scope: tuple[str, str, str, str]
    extremes: list[tuple[str, str]]
    gain: float
    start_s: float
    end_s: float
    fade_s: float


def read(
    path: str | Path, known: Sequence[extremes.Extreme], character: str, shot: str
) -> list[Row]:
    """Read the rows of one take; rows of others are checked as well.

    Parameters
    ----------
    path : the table, or an empty text for none
    known : the table of extremes
    character, shot : of the take

    Raises
    ------
    errors.InputError
        naming the line of an unknown name, a gain or time that means nothing, or of a row that
        meets one of the same scope
    """
    rows: list[Row] = []
    for cells in delimited.read(path, REQUIRED, OPTIONAL) if path else []:
        row = _row(path, cells, known)
        for other in rows:
            meet = row.start_s < other.end_s and other.start_s < row.end_s
            if row.scope == other.scope and meet:
                message = f"line {row.line}: meets line {other.line}, which says the same of"
                message += f" {' '.join(filter(None, row.scope))}: end one before the other starts"
                raise errors.InputError(path, message)
        rows.append(row)
    return [row for row in rows if row.scope[0] == character and row.scope[1] in ("", shot)]


def directions(rows: Sequence[Row], listed: Sequence[tuple[str, str]]) -> list[directing.Direction]:
    """Return the rows as changes of the K extremes that a take has."""
    return [
        directing.Direction(
            np.array([k for k, extreme in enumerate(listed) if extreme in row.extremes], int),
            row.gain,
            row.start_s,
            row.end_s,
            row.fade_s,
        )
        for row in rows
    ]


def _row(path: str | Path, row: delimited.Row, known: Sequence[extremes.Extreme]) -> Row:
    """Return one row, checked."""
    cells = dict.fromkeys(OPTIONAL, "") | row.cells
    row = delimited.Row(row.line, cells)
    gain = delimited.number(path, row, "gain")
    if not 0 <= gain <= MOST_GAIN:
        message = f"line {row.line}, column gain: '{cells['gain']}' is not within 0 and"
        raise errors.InputError(path, f"{message} {MOST_GAIN:g}: correct it")
    start = delimited.number(path, row, "start_s") if cells["start_s"] else -math.inf
    end = delimited.number(path, row, "end_s") if cells["end_s"] else math.inf
    fade = delimited.number(path, row, "fade_s") if cells["fade_s"] else FADE_S
    try:
        directing.presence(np.zeros(0), start, end, fade)
    except ValueError as error:
        message = f"line {row.line}: {error}: correct start_s, end_s or fade_s"
        raise errors.InputError(path, message) from error
    scope = cells["character"], cells["shot"], cells["layer"], cells["name"]
    return Row(row.line, scope, _extremes(path, row, known), gain, start, end, fade)


def _extremes(
    path: str | Path, row: delimited.Row, known: Sequence[extremes.Extreme]
) -> list[tuple[str, str]]:
    """Return layer and name of the extremes that a row means."""
    layer, name = row.cells["layer"], row.cells["name"]
    if layer not in extremes.LAYERS:
        message = f"line {row.line}, column layer: '{layer}' is no layer"
        raise errors.InputError(path, f"{message}: write {', '.join(extremes.LAYERS)}")
    mates = [each for each in known if each.layer == layer]
    found = [each for each in mates if name in ("", each.family)]
    found = found or [each for each in mates if each.name == name]
    if not found:
        near = extremes.nearest(known, layer, name)
        message = f"line {row.line}, column name: {layer} has no '{name}', is it {near}?"
        raise errors.InputError(path, message + ": correct it, or leave it blank for the layer")
    return [(each.layer, each.name) for each in found]
