"""Times of words as GRID's `.align` files hold them: start, end and word, in 1/25000 s."""

import itertools
from pathlib import Path
from typing import NamedTuple

from stages.files import errors, text_file

UNITS_PER_S = 25000
SILENCES = ("sil", "sp")


class Span(NamedTuple):
    """A word and the time that it spans [s] from the start of the sound."""

    start_s: float
    end_s: float
    word: str


def read(path: str | Path) -> list[Span]:
    """Read the words in the order of time, without the silences.

    Raises
    ------
    errors.InputError
        naming the line that is no word with its times, or overlaps the one before
    """
    spans = []
    for number, line in enumerate(text_file.read(path).splitlines(), start=1):
        if not line.strip():
            continue
        cells = line.split()
        if len(cells) != 3 or not (cells[0].isdecimal() and cells[1].isdecimal()):
            message = f"line {number} is '{line.strip()}': write start, end (1/25000 s) and word"
            raise errors.InputError(path, message)
        start, end = int(cells[0]), int(cells[1])
        if start >= end:
            raise errors.InputError(path, f"line {number}: '{cells[2]}' ends before it starts")
        spans.append((number, Span(start / UNITS_PER_S, end / UNITS_PER_S, cells[2].lower())))
    for (_, one), (number, other) in itertools.pairwise(spans):
        if other.start_s < one.end_s:
            message = f"line {number}: '{other.word}' starts before '{one.word}' ends"
            raise errors.InputError(path, f"{message}: correct one of them")
    words = [span for _, span in spans if span.word not in SILENCES]
    if not words:
        raise errors.InputError(path, "holds no word: leave the cell of shots.tsv blank")
    return words
