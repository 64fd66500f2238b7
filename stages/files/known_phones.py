"""Phones or mouth shapes that another program found: what each kind of file means as rows.

TextGrid holds phones, and Rhubarb's files mouth shapes, which are visemes of their own
(`rhubarb_A` and so on, no phone). Times count from the start of the sound.
"""

import json
from pathlib import Path

from stages.files import errors, mouth_cues, phones, text_file, text_grid, visemes


def read(path: str | Path, table: dict[str, str]) -> list[phones.Phone]:
    """Read phones with their visemes, or mouth shapes, in the order of time.

    Parameters
    ----------
    path : .TextGrid; .tsv or .xml of Rhubarb; .json of either
    table : phone -> viseme

    Raises
    ------
    errors.InputError
        if the file is of another kind or names a phone that the table lacks
    """
    suffix = Path(path).suffix.lower()
    if suffix in (".tsv", ".xml") or (suffix == ".json" and _has_mouth_cues(path)):
        return [phones.Phone(a, b, "", f"rhubarb_{shape}") for a, b, shape in mouth_cues.read(path)]
    if suffix not in (".textgrid", ".json"):
        message = f"ends in '{suffix}': give a .TextGrid, or a .tsv, .json or .xml of Rhubarb"
        raise errors.InputError(path, message)
    intervals = text_grid.read(path)
    names = [visemes.name_of(interval.label) for interval in intervals]
    shown = visemes.look_up(path, table, names)
    rows = []
    for (start, end, _, word), name, viseme in zip(intervals, names, shown, strict=True):
        if viseme == table[visemes.SILENCE]:
            rows.append(phones.Phone(start, end, visemes.SILENCE, viseme))
        else:
            rows.append(phones.Phone(start, end, name, viseme, word))
    return rows


def _has_mouth_cues(path: str | Path) -> bool:
    """Return whether a JSON file is Rhubarb's; what is no JSON is said to be no TextGrid."""
    try:
        found = json.loads(text_file.read(path))
    except json.JSONDecodeError:
        return False
    return isinstance(found, dict) and "mouthCues" in found
