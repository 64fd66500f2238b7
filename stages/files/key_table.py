"""`keys.csv`, a row `channel, frame, value` for each key, and `keys.json`, what they cost.

Frames count at the character's rate; programs interpolate linearly between keys.
"""

import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from stages.files import atomic


def write(
    path: str | Path, names: Sequence[str], frame: np.ndarray, values: np.ndarray, kept: np.ndarray
) -> None:
    """Write the keys, channel by channel, each value with all its digits.

    Parameters
    ----------
    path : the file
    names : of the K channels
    frame : (T,) int array
    values : (T, K) float array
    kept : (T, K) bool array, the keys
    """
    with (
        atomic.replacing(path) as temporary,
        temporary.open("w", encoding="utf-8", newline="\n") as stream,
    ):
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(["channel", "frame", "value"])
        for channel, name in enumerate(names):
            for row in np.flatnonzero(kept[:, channel]):
                # the shortest text that gives the number back
                rows.writerow([name, frame[row], repr(float(values[row, channel]))])


def write_error(path: str | Path, counts: Mapping[str, int], figures: Mapping) -> None:
    """Write figures of a take, its number of keys and those of each channel."""
    data = dict(figures) | {"keys": sum(counts.values()), "keys_of_channels": dict(counts)}
    text = json.dumps(data, indent=1, ensure_ascii=False) + "\n"
    with atomic.replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
