"""`pairs/<animator>.tsv` or `.csv`: frames of an actor, and the weights tuned for them.

Columns `shot`, `frame` and any shapes of the rig by their plain names (`jawOpen`, not
`face.jawOpen`). A blank cell is 0, and so is a shape without a column. Each animator has a file.
"""

import csv
import dataclasses
import difflib
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

import numpy as np

from stages.files import channels, delimited, errors

SEPARATORS = {".tsv": "\t", ".csv": ","}
KEYS = ("shot", "frame")


@dataclasses.dataclass(frozen=True)
class Pair:
    """A frame and its tuned weights.

    Attributes
    ----------
    path, line : where it is written
    animator : the name of the file
    shot, frame : what was tuned
    weights : (K,) float array, in the order of the rig's names
    """

    path: str
    line: int
    animator: str
    shot: str
    frame: int
    weights: np.ndarray


def read(
    paths: Sequence[str | Path],
    frames: Mapping[str, Collection[int]],
    others: Collection[str],
    limits: channels.Channels,
) -> list[Pair]:
    """Read the pairs of an actor, all animators' files in the order given.

    Parameters
    ----------
    paths : the tables
    frames : shot -> its frames, for the shots that pairs of this actor may name
    others : shots of other actors, whose rows are left aside
    limits : the shapes `<mask>.<shape>` of the rig with their low and high

    Raises
    ------
    errors.InputError
        naming the line and column of a shot, frame or shape that does not exist, of a weight that
        is no number or out of range, and of a frame that an animator tuned twice
    """
    found: list[Pair] = []
    owner: dict[str, str | Path] = {}
    for path in paths:
        animator = Path(path).stem
        if animator in owner:
            message = f"{owner[animator]} is of the same animator: join the two or rename one"
            raise errors.InputError(path, message)
        owner[animator] = path
        found += _read_one(path, animator, frames, others, limits)
    return found


def _read_one(
    path: str | Path,
    animator: str,
    frames: Mapping[str, Collection[int]],
    others: Collection[str],
    limits: channels.Channels,
) -> list[Pair]:
    """Read one animator's pairs."""
    separator = SEPARATORS.get(Path(path).suffix.lower())
    if separator is None:
        raise errors.InputError(path, "pairs are .tsv or .csv files: rename it")
    index = {name.partition(".")[2]: k for k, name in enumerate(limits.names)}
    columns = _shape_columns(path, separator, index)
    found, line_of = [], {}
    for row in delimited.read(path, KEYS, columns, separator):
        shot = row.cells["shot"]
        if shot in others:
            continue
        frame = _frame(path, row, frames)
        if (shot, frame) in line_of:
            message = f"frame {frame} of {shot} stands in line {line_of[shot, frame]} already"
            raise errors.InputError(path, f"line {row.line}: {message}, remove one")
        line_of[shot, frame] = row.line
        weights = np.zeros(len(limits.names))
        for column in columns:
            if row.cells[column]:
                k = index[column]
                bounds = limits.low[k], limits.high[k]
                weights[k] = _weight(path, row, column, bounds)
        found.append(Pair(str(path), row.line, animator, shot, frame, weights))
    return found


def _shape_columns(path: str | Path, separator: str, index: Mapping[str, int]) -> list[str]:
    """Return the shapes in the table's header."""
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as stream:
            header = next(csv.reader(stream, delimiter=separator), [])
    except (FileNotFoundError, UnicodeDecodeError):
        return []  # the reader of the rows says so
    names = [name.strip() for name in header]
    for name in names:
        if name not in index and name not in KEYS:
            near = difflib.get_close_matches(name, index, 1) or [next(iter(index))]
            between = "tabs" if separator == "\t" else "commas"
            message = f"line 1: the rig has no shape '{name}', the nearest name is {near[0]}"
            raise errors.InputError(path, f"{message}: rename or remove it; {between} part columns")
    return [name for name in dict.fromkeys(names) if name not in KEYS]


def _frame(path: str | Path, row: delimited.Row, frames: Mapping[str, Collection[int]]) -> int:
    """Return the frame of a row, once shot and frame are known to exist."""
    shot = row.cells["shot"]
    if shot not in frames:
        message = f"line {row.line}, column shot: '{shot}' is none of {', '.join(frames)}"
        cure = "only basis shots of the actor may be tuned, see shots.tsv"
        raise errors.InputError(path, f"{message}: {cure}")
    frame = delimited.whole_number(path, row, "frame")
    if frame not in frames[shot]:
        known = f"{shot} has frames {min(frames[shot])} to {max(frames[shot])}"
        message = f"line {row.line}, column frame: {known}, not {frame}"
        raise errors.InputError(path, message + ": write the frame that was tuned")
    return frame


def _weight(
    path: str | Path, row: delimited.Row, column: str, bounds: tuple[float, float]
) -> float:
    """Return a cell's weight, once it is known to lie in its channel's range."""
    value = delimited.number(path, row, column)
    low, high = bounds
    if not low <= value <= high:
        message = f"line {row.line}, column {column}: {value:g} is not within {low:g} and {high:g}"
        raise errors.InputError(path, message + ": mend it, or the limits of the channel")
    return value
