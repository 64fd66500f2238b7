"""The table of extremes: what every corner of a simplex is called (K11 section 3.1).

Columns: layer (`emotion`, `speech` or `blink`), name, family, degree, note. Emotions are those of
Plutchik: each family has three degrees, 1 mild to 3 strong, and what lies between two families is a
blend, without a family of its own. An extreme's name on a character is `<layer>_<name>`.
"""

import difflib
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from stages.files import delimited, errors

LAYERS = ("emotion", "speech", "blink")
# the extreme of each layer that a character's neutral shows where it has no pose of that name
AT_REST = {"emotion": "neutral", "speech": "rest", "blink": "open"}
CLOSED_LIPS = ("speech", "m")
COLUMNS = ("layer", "name", "family", "degree", "note")
DEGREES = ("1", "2", "3")


class Extreme(NamedTuple):
    """A row of the table; degree is 0 where the extreme belongs to no family."""

    layer: str
    name: str
    family: str
    degree: int
    note: str


def read(path: str | Path) -> list[Extreme]:
    """Read the table.

    Raises
    ------
    errors.InputError
        if a layer is unknown, a name stands twice in its layer, or family and degree do not belong
        together
    """
    found: dict[tuple[str, str], Extreme] = {}
    for row in delimited.read(path, COLUMNS):
        cells, where = row.cells, f"line {row.line}"
        layer, name, family, degree = (cells[column] for column in COLUMNS[:4])
        if layer not in LAYERS:
            message = f"{where}: '{layer}' is no layer: write {', '.join(LAYERS)}"
            raise errors.InputError(path, message)
        if not name or (layer, name) in found:
            message = f"{where}: {layer} '{name}' stands twice or has no name: remove it"
            raise errors.InputError(path, message)
        if bool(family) != bool(degree) or (degree and degree not in DEGREES):
            message = f"{where}: family '{family}' and degree '{degree}' do not belong together"
            raise errors.InputError(path, f"{message}: give both, the degree 1 to 3, or none")
        found[layer, name] = Extreme(layer, name, family, int(degree or 0), cells["note"])
    return list(found.values())


def rests(layers: Sequence[str], listed: Sequence[tuple[str, str]]) -> list[int]:
    """Return where the neutral of each layer stands in a list of (layer, name), -1 for nowhere."""
    wanted = [(layer, AT_REST[layer]) for layer in layers]
    return [listed.index(extreme) if extreme in listed else -1 for extreme in wanted]


def nearest(known: Sequence[Extreme], layer: str, name: str) -> str:
    """Return the extreme of a layer whose name is most like another, for an error."""
    names = [each.name for each in known if each.layer == layer]
    return (difflib.get_close_matches(name, names, 1) or names)[0]
