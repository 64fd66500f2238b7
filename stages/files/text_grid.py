"""Phones of an aligner as Praat TextGrid (long, short, JSON), and the words they belong to.

The tier `phones` is read, else the only tier `<speaker> - phones` that holds any; words are from
the tier `words` of the same speaker, if there is one. Times count from the start of the sound.
"""

import itertools
import json
import math
import re
from pathlib import Path
from typing import NamedTuple

from praatio.utilities import errors as praatio_errors
from praatio.utilities import textgrid_io

from stages.files import errors, text_file

TOLERANCE_S = 1e-3
# number of tiers, which both text layouts state after the line that says that there are any
PROMISED = re.compile(r"<exists>\s+(?:size\s*=\s*)?(\d+)")


class Interval(NamedTuple):
    """A label and the time that it spans [s]; word is blank where none is known."""

    start_s: float
    end_s: float
    label: str
    word: str = ""


def read(path: str | Path) -> list[Interval]:
    """Read the phones of the only speaker, in the order of time.

    Raises
    ------
    errors.InputError
        if the file is no TextGrid or is cut short, has no phones or those of several speakers, or
        if intervals overlap
    """
    tiers = _tiers(path)
    name = _tier_of_phones(path, tiers)
    phones = _intervals(path, name, tiers[name])
    if not phones:
        raise errors.InputError(path, f"tier '{name}' is empty: align the sound again")
    spoken = name[: -len("phones")] + "words"
    words = _intervals(path, spoken, tiers[spoken]) if spoken in tiers else []
    return [phone._replace(word=_word_at(words, phone)) for phone in phones]


def _tiers(path: str | Path) -> dict[str, dict]:
    """Return the tiers of intervals by their names in lower case."""
    text = text_file.read(path)
    try:
        parsed = textgrid_io.parseTextgridStr(text, includeEmptyIntervals=True)
        found = [(tier["class"], tier["name"].strip().lower(), tier) for tier in parsed["tiers"]]
    except (praatio_errors.PraatioException, ArithmeticError, LookupError) as error:
        raise _no_text_grid(path) from error
    except (AttributeError, TypeError, ValueError) as error:
        raise _no_text_grid(path) from error
    promised = PROMISED.search(text)
    if not _is_json(text) and (promised is None or len(found) < int(promised[1])):
        raise errors.InputError(path, "is cut short: it lacks tiers; copy it again")
    tiers: dict[str, dict] = {}
    for kind, name, tier in found:
        if kind == "IntervalTier":
            if name in tiers:
                raise errors.InputError(path, f"two tiers are named '{name}': rename one")
            tiers[name] = tier | {"tiled": not _is_json(text)}
    return tiers


def _no_text_grid(path: str | Path) -> errors.InputError:
    """Return the error of a file that cannot be read as a TextGrid."""
    message = "is no TextGrid, or is cut short: save it by Praat or MFA as long, short or JSON"
    return errors.InputError(path, message)


def _is_json(text: str) -> bool:
    """Return whether a text is JSON, which cannot be cut short unseen."""
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


def _tier_of_phones(path: str | Path, tiers: dict[str, dict]) -> str:
    """Return the name of the tier of phones, the only speaker's if they are several."""
    if "phones" in tiers:
        return "phones"
    speakers = [name for name in tiers if name.endswith(" - phones")]
    speaking = [name for name in speakers if any(e[-1].strip() for e in tiers[name]["entries"])]
    if len(speaking) > 1:
        message = f"has phones of several speakers ({'; '.join(speaking)})"
        raise errors.InputError(path, f"{message}: rename the wanted tier 'phones'")
    if not speaking:
        named = ", ".join(f"'{name}'" for name in tiers) or "none"
        message = f"has no tier 'phones' with phones (its tiers of intervals: {named})"
        raise errors.InputError(path, f"{message}: rename the tier that holds them")
    return speaking[0]


def _intervals(path: str | Path, name: str, tier: dict) -> list[Interval]:
    """Return a tier's intervals, checked: they have a length, do not overlap, and are all there."""
    intervals = []
    for start, end, label in tier["entries"]:
        try:
            interval = Interval(float(start), float(end), str(label).strip())
        except ValueError:
            raise _no_text_grid(path) from None
        if not 0 <= interval.start_s < interval.end_s < math.inf:
            message = f"tier '{name}': '{label}' spans {start} to {end} s: give it a length"
            raise errors.InputError(path, message)
        intervals.append(interval)
    intervals.sort()
    for one, other in itertools.pairwise(intervals):
        if other.start_s < one.end_s - TOLERANCE_S:
            message = f"tier '{name}': '{other.label}' at {other.start_s:g} s starts before"
            cure = "move one of them"
            raise errors.InputError(path, f"{message} '{one.label}' ends, {one.end_s:g} s: {cure}")
    last = intervals[-1].end_s if intervals else 0.0
    if tier["tiled"] and last < float(tier["xmax"]) - TOLERANCE_S:
        message = f"is cut short: tier '{name}' ends at {last:g} s of {float(tier['xmax']):g} s"
        raise errors.InputError(path, f"{message}; copy it again, or save it with its silences")
    return intervals


def _word_at(words: list[Interval], phone: Interval) -> str:
    """Return the word that is spoken in the middle of a phone."""
    middle = (phone.start_s + phone.end_s) / 2
    return next((word.label for word in words if word.start_s <= middle < word.end_s), "")
