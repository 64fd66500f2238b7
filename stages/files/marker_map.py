"""Marker maps: tab-separated `marker, name`, the file's label and the show's name for it.

A blank name leaves the marker out. Markers that are not listed keep their label, without what
stands before a colon (the subject, in many files). Names hold no dot, colon or slash.
"""

from collections.abc import Sequence
from pathlib import Path

from stages.files import delimited, errors

COLUMNS = ("marker", "name")
FORBIDDEN = ".:/\\\t"


def read(path: str | Path) -> dict[str, str]:
    """Read a map: label -> name.

    Raises
    ------
    errors.InputError
        naming the line of a label that stands twice or of a name that is not allowed
    """
    names: dict[str, str] = {}
    for row in delimited.read(path, COLUMNS):
        marker, name = row.cells["marker"], row.cells["name"]
        if not marker or marker in names:
            message = f"line {row.line}: marker '{marker}' is blank or stands twice: remove one"
            raise errors.InputError(path, message)
        if any(letter in name for letter in FORBIDDEN):
            message = f"line {row.line}: name '{name}' holds a dot, colon or slash: choose another"
            raise errors.InputError(path, message)
        names[marker] = name
    return names


def apply(
    file: str | Path, labels: Sequence[str], map_path: str | Path, mapped: dict[str, str]
) -> dict[int, str]:
    """Return the markers that are kept: place in the file -> name.

    Parameters
    ----------
    file : the marker file, for errors
    labels : its P labels
    map_path : the map's file, for errors
    mapped : label -> name; a label may also be given without its subject

    Raises
    ------
    errors.InputError
        if the file lacks a marker of the map, or a name is not allowed or stands twice
    """
    bare = [label.rpartition(":")[2].strip() for label in labels]
    if unknown := [marker for marker in mapped if marker not in labels and marker not in bare]:
        message = f"names marker '{unknown[0]}', which {file} lacks ({len(unknown)} such rows)"
        raise errors.InputError(map_path, message + ": correct or remove the row")
    kept: dict[int, str] = {}
    for place, (label, short) in enumerate(zip(labels, bare, strict=True)):
        name = mapped.get(label, mapped.get(short, short))
        if not name:
            continue
        if any(letter in name for letter in FORBIDDEN):
            message = f"marker '{label}' holds a dot or slash: rename it in a marker map"
            raise errors.InputError(file, message)
        if name in kept.values():
            message = f"two markers would be named '{name}', one of them '{label}'"
            raise errors.InputError(file, message + ": rename one in a marker map")
        kept[place] = name
    if not kept:
        raise errors.InputError(map_path, f"leaves no marker of {file}: name some")
    return kept
