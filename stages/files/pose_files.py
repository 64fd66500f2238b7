"""A character's extremes as files of one folder, `<layer>_<name>`.

A pose is a file of the neutral's kind, a mesh or a table of controls; for a mesh also a
comma-separated table `name,value` of the artist's blendshapes, each a mesh of its own, of which the
value says how much: 1 is the whole shape. Blendshapes that a table does not name are at 0.
"""

import difflib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from stages.files import delimited, errors, sculpts


def by_name(
    paths: Sequence[str], folder: str | Path, known: Sequence[tuple[str, str]]
) -> dict[tuple[str, str], str]:
    """Return the file of each (layer, name) that the character has, in the order of all extremes.

    Parameters
    ----------
    paths : files of the folder
    folder : where they are
    known : layer and name of every extreme there is

    Raises
    ------
    errors.InputError
        if there is no pose, one has a name that no extreme has, or two have the same name
    """
    if not paths:
        message = "holds no pose: save each extreme as <layer>_<name>, such as emotion_joy.ply"
        raise errors.InputError(folder, message)
    spelt = {"_".join(extreme): extreme for extreme in known}
    found: dict[tuple[str, str], str] = {}
    for path in paths:
        stem = Path(path).stem
        if stem not in spelt:
            near = difflib.get_close_matches(stem, spelt, 1)
            hint = f", is it {near[0]}?" if near else ""
            message = f"'{stem}' is no extreme's <layer>_<name>{hint}: rename it"
            raise errors.InputError(path, message + " after the table of extremes")
        if spelt[stem] in found:
            message = f"{stem} is also {Path(found[spelt[stem]]).name}: remove one"
            raise errors.InputError(path, message)
        found[spelt[stem]] = path
    return {extreme: found[extreme] for extreme in known if extreme in found}


def read(
    paths: Mapping[tuple[str, str], str], neutral: sculpts.Pose, shapes: Mapping[str, str]
) -> dict[tuple[str, str], np.ndarray]:
    """Read how poses differ from the neutral.

    Parameters
    ----------
    paths : (layer, name) -> pose
    neutral : the character's neutral
    shapes : name -> file of the artist's blendshapes

    Returns
    -------
    (layer, name) -> (V, D) float array

    Raises
    ------
    errors.InputError
        if a file does not fit the neutral, or names a blendshape that is not there
    """
    mixes = {
        extreme: _read_mix(path, shapes)
        for extreme, path in paths.items()
        if Path(path).suffix.lower() == sculpts.CONTROL_SUFFIX and not neutral.is_controls
    }
    # each is read once, and none that no pose names
    used = {name: shapes[name] for mix in mixes.values() for name in mix}
    parts = {name: _offset(path, neutral) for name, path in used.items()}
    still = np.zeros_like(neutral.coordinates)
    return {
        extreme: sum((value * parts[name] for name, value in mixes[extreme].items()), still)
        if extreme in mixes
        else _offset(path, neutral)
        for extreme, path in paths.items()
    }


def _offset(path: str | Path, neutral: sculpts.Pose) -> np.ndarray:
    """Read how a file of the neutral's kind differs from it."""
    return sculpts.read_sculpt(path, neutral)[0] - neutral.coordinates


def _read_mix(path: str | Path, shapes: Mapping[str, str]) -> dict[str, float]:
    """Read a table of the artist's blendshapes."""
    mix: dict[str, float] = {}
    for row in delimited.read(path, ("name", "value"), separator=","):
        name, where = row.cells["name"], f"line {row.line}, column name"
        if name not in shapes:
            near = difflib.get_close_matches(name, shapes, 1)
            hint = f"is it {near[0]}?" if near else f"there are {len(shapes)} blendshapes"
            message = f"{where}: there is no blendshape '{name}', {hint}: correct the name"
            raise errors.InputError(path, message)
        if name in mix:
            raise errors.InputError(path, f"{where}: '{name}' stands twice: remove one")
        mix[name] = delimited.number(path, row, "value")
    return mix
