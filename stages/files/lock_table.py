"""`key_shapes.tsv`: frames that an artist locked as key shapes, or banned."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from stages.files import delimited, errors

COLUMNS = ("actor", "region", "shot", "frame", "state")
STATES = ("locked", "banned")

Locks = dict[str, dict[str, list[int]]]


def locking(path: str | Path, actor: str, shapes: Iterable[tuple[str, str, int]]) -> str:
    """Return the text of a table that locks an actor's key shapes and keeps the actor's bans.

    Parameters
    ----------
    path : the table that holds the bans
    actor : whose rows are written
    shapes : (region, shot, frame) of each key shape
    """
    rows = [(actor, region, shot, str(frame), "locked") for region, shot, frame in shapes]
    for row in delimited.read(path, COLUMNS):
        if row.cells["actor"] == actor and row.cells["state"] == "banned":
            rows.append(tuple(row.cells[column] for column in COLUMNS))
    return delimited.as_text(COLUMNS, rows)


def read(path: str | Path, actor: str, place: Mapping[tuple[str, int], int]) -> Locks:
    """Read an actor's rows: region -> state -> rows of the basis, in the table's order.

    Parameters
    ----------
    path : the table
    actor : rows of others are left aside
    place : (shot, frame) -> row of the basis

    Raises
    ------
    errors.InputError
        naming line and column of a state that does not exist or a frame outside the basis
    """
    found: Locks = {}
    for row in delimited.read(path, COLUMNS):
        if row.cells["actor"] != actor:
            continue
        shot, frame = row.cells["shot"], delimited.whole_number(path, row, "frame")
        state, where = row.cells["state"], f"line {row.line}"
        if state not in STATES:
            message = f"{where}, column state: '{state}' is not {' or '.join(STATES)}"
            raise errors.InputError(path, message)
        if (shot, frame) not in place:
            message = f"{where}: frame {frame} of shot {shot} is outside the basis"
            raise errors.InputError(
                path, message + f": set basis to yes for {shot} in shots.tsv or remove the row"
            )
        index = place[shot, frame]
        rows = found.setdefault(row.cells["region"], {name: [] for name in STATES})
        if index in rows["locked"] + rows["banned"]:
            raise errors.InputError(path, f"{where}: the same frame stands above, remove one row")
        rows[state].append(index)
    return found
