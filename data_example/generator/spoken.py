"""Read the sentences of the marker takes: their voice, their words and true phones.

The voice is Festival's kal_diphone; say.scm made it. Times count from a sentence's first phone.
"""

import csv
import pathlib
from typing import NamedTuple

import av
import numpy as np
from scipy import signal

FOLDER = pathlib.Path(__file__).parent
RATE = 16000
# what voice.ogg holds of each sentence before its first phone and after its last one [s]
BEFORE, AFTER = 0.04, 0.12
VOICED = ("neutral", "happiness", "anger", "sadness")
# ARPAbet to the sounds of speech.VISEMES; diphthongs and affricates are two, one after the other
MOUTHS = {
    "b": "m", "p": "m", "m": "m", "f": "f", "v": "f", "th": "th", "dh": "th", "t": "t", "d": "t",
    "n": "t", "s": "s", "z": "s", "sh": "sh", "zh": "sh", "ch": "t sh", "jh": "t sh", "k": "k",
    "g": "k", "ng": "k", "hh": "k", "r": "r", "er": "r", "l": "l", "w": "w", "y": "ee",
    "aa": "aa", "ao": "oh", "ae": "ae", "ah": "uh", "ax": "uh", "eh": "eh", "ih": "ih",
    "iy": "ee", "ey": "eh ih", "ay": "aa ih", "aw": "aa oo", "ow": "oh oo", "oy": "oh ih",
    "uh": "oo", "uw": "oo", "pau": "_",
}  # fmt: skip


class Phone(NamedTuple):
    """A phone of a sentence: its word (blank in a pause), ARPAbet name, start and end [s]."""

    word: str
    name: str
    start: float
    end: float


def phones():
    """Return the phones of every sentence, name -> list of Phone."""
    result = {}
    with (FOLDER / "phones.tsv").open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream, delimiter="\t"):
            phone = Phone(row["word"], row["phone"], float(row["start_s"]), float(row["end_s"]))
            result.setdefault(row["sentence"], []).append(phone)
    return result


def moved(sentence, start):
    """Return the phones of a sentence that starts at a time [s]."""
    return [p._replace(start=p.start + start, end=p.end + start) for p in sentence]


def mouths(sentence):
    """Return a sentence as the sounds that speech.mouth_tracks forms, (name, start, end) [s]."""
    result = []
    for phone in sentence:
        names = MOUTHS[phone.name].split()
        ends = np.linspace(phone.start, phone.end, len(names) + 1)
        result += list(zip(names, ends[:-1], ends[1:], strict=True))
    return result


def words(sentence):
    """Return the words of a sentence as (word, start, end) [s]; pauses have a blank word."""
    result = []
    for phone in sentence:
        if result and result[-1][0] == phone.word:
            result[-1] = (phone.word, result[-1][1], phone.end)
        else:
            result.append((phone.word, phone.start, phone.end))
    return result


def voice(starts, duration_s):
    """Return the voice, each sentence from its own time on, at RATE.

    Parameters
    ----------
    starts : dict, name of a voiced sentence -> time of its first phone [s]
    duration_s : float

    Returns
    -------
    samples : (S,) float64 array in -1..1
    """
    with av.open(str(FOLDER / "voice.ogg")) as container:
        blocks = [frame.to_ndarray() for frame in container.decode(audio=0)]
    # Opus always decodes to 48 kHz
    kept = signal.resample_poly(np.concatenate(blocks, axis=1)[0], 1, 3)
    spoken, at = phones(), 0
    result = np.zeros(round(duration_s * RATE))
    for name in VOICED:
        count = round((BEFORE + spoken[name][-1].end + AFTER) * RATE)
        first = round((starts[name] - BEFORE) * RATE)
        result[first : first + count] += kept[at : at + count]
        at += count
    return result
