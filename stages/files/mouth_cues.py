"""Mouth shapes by Rhubarb Lip Sync, as TSV, JSON or XML: shapes A to H and X, visemes of their own.

Every cue lasts until the next one starts. Times count from the start of the sound.
"""

import itertools
import json
import math
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from stages.files import errors, text_file

SHAPES = "ABCDEFGHX"


class Cue(NamedTuple):
    """A mouth shape and the time that it spans [s]."""

    start_s: float
    end_s: float
    shape: str


def read(path: str | Path) -> list[Cue]:
    """Read mouth shapes; the ending of the path says in which layout.

    Raises
    ------
    errors.InputError
        if the file is of another layout, or a shape or a time is none
    """
    reader = {".tsv": _from_tsv, ".json": _from_json, ".xml": _from_xml}[Path(path).suffix.lower()]
    try:
        found = [Cue(float(a), float(b), str(shape).strip()) for a, b, shape in reader(path)]
    except (ValueError, LookupError, TypeError, ElementTree.ParseError) as error:
        if isinstance(error, errors.InputError):
            raise
        message = f"holds no mouth cues of Rhubarb ({error}): export it again, whole"
        raise errors.InputError(path, message) from error
    if not found:
        raise errors.InputError(path, "holds no mouth cue: export it again, whole")
    for cue in found:
        if cue.shape not in SHAPES or len(cue.shape) != 1:
            message = f"'{cue.shape}' at {cue.start_s:g} s is no mouth shape"
            raise errors.InputError(path, f"{message}: they are {', '.join(SHAPES)}")
        if not 0 <= cue.start_s < cue.end_s < math.inf:
            message = f"shape {cue.shape} spans {cue.start_s:g} to {cue.end_s:g} s"
            raise errors.InputError(path, f"{message}: give it a length")
    for one, other in itertools.pairwise(found):
        if other.start_s < one.end_s - 1e-6:
            message = f"shape {other.shape} at {other.start_s:g} s starts before the one before it"
            raise errors.InputError(path, f"{message} ends: move one of them")
    return found


def _from_tsv(path: str | Path) -> list[tuple]:
    """Return cues of a table without a header; its last line only says when all ends."""
    rows = [line.split("\t") for line in text_file.read(path).splitlines() if line.strip()]
    starts = [(float(time), shape) for time, shape in rows]
    if len(starts) < 2:
        raise errors.InputError(path, "has no two lines: export it again, whole")
    return [(a, b, shape) for (a, shape), (b, _) in itertools.pairwise(starts)]


def _from_json(path: str | Path) -> list[tuple]:
    """Return the cues of a JSON object."""
    cues = json.loads(text_file.read(path))["mouthCues"]
    return [(cue["start"], cue["end"], cue["value"]) for cue in cues]


def _from_xml(path: str | Path) -> list[tuple]:
    """Return the cues of an XML document."""
    text_file.read(path)
    root = ElementTree.fromstring(Path(path).read_bytes())
    return [(cue.attrib["start"], cue.attrib["end"], cue.text) for cue in root.iter("mouthCue")]
