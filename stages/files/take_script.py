"""Scripts for animation programs: a template of Python in which the line of the take is replaced.

The take is a JSON text, so that programs read long ones fast.
"""

import json
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from stages.core import curve_keys
from stages.files import errors

MARK = 'TAKE = json.loads("{}")\n'


def curves(
    names: Iterable[str], frame: np.ndarray, values: np.ndarray
) -> dict[str, list[list[float]]]:
    """Return the keys `[frame, value]` of (T, C) curves by name, without those that say nothing."""
    found = {}
    for name, curve in zip(names, values.T, strict=True):
        rows = curve_keys.needed(curve)
        found[name] = [[int(frame[row]), float(f"{curve[row]:.9g}")] for row in rows]
    return found


def write(path: str | Path, template: str | Path, data: dict) -> None:
    """Write a script.

    Raises
    ------
    errors.InputError
        if the template has no place for the take
    """
    text = Path(template).read_text(encoding="utf-8")
    if text.count(MARK) != 1:
        raise errors.InputError(template, f"has no line '{MARK.strip()}': restore the template")
    take = json.dumps(data, ensure_ascii=True)
    Path(path).write_text(text.replace(MARK, f'TAKE = json.loads(r"""{take}""")\n'), "utf-8")
