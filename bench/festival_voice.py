"""Have Festival speak thirty sentences: sound, words and phones with their true times.

Festival is no part of the project: `available()` says whether it is installed.
"""

import itertools
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stages.files import sound

RATE = 16000
SPEAK = """(voice_kal_diphone)
(define (speak text base)
  (let ((spoken (utt.synth (eval (list 'Utterance 'Text text)))))
    (utt.save.segs spoken (string-append base ".segs"))
    (utt.save.words spoken (string-append base ".words"))
    (utt.save.wave spoken (string-append base ".wav") 'riff)))
"""
SENTENCES = (
    "The quick brown fox jumps over the lazy dog.",
    "Please bring the red boat to the harbor before noon.",
    "She sells sea shells by the shore every summer.",
    "My father thought the weather would be much better by now.",
    "We must leave the house at eight if we want to catch the train.",
    "The old man gave his dog a big piece of fresh bread.",
    "A large yellow truck stopped near the village church.",
    "Both children played with a rubber ball in the garden.",
    "You should measure the width of every window twice.",
    "The judge asked for silence and then began to speak.",
    "Five small birds were sitting on the garden fence.",
    "He pushed the heavy box across the kitchen floor.",
    "Nothing could make the young queen change her mind.",
    "The boy who broke the vase was hiding under the table.",
    "I usually drink a cup of coffee with milk in the morning.",
    "Thank you for the pleasure of your company this evening.",
    "Their voices were lost in the noise of the machine.",
    "The path through the forest was covered with thick mud.",
    "Why would anyone choose to live in such a cold place?",
    "Her brother works as a teacher in a school by the river.",
    "The moon was bright enough to read the paper outside.",
    "Put the blue book on the top shelf beside the clock.",
    "They found an oyster and a few other shells at the beach.",
    "This cheese smells awful but the flavor is very good.",
    "The doctor will join us for lunch on Thursday.",
    "Few people knew how deep the water was below the bridge.",
    "A cool breeze blew in from the ocean after sunset.",
    "The singer took a long breath and closed her eyes.",
    "It is easy to forget how much work went into the show.",
    "Watch the sparks fly when the metal touches the wheel.",
)


class Spoken(NamedTuple):
    """A sentence: (N,) samples at RATE, its words, and spans (start [s], end [s], name)."""

    samples: np.ndarray
    words: list[str]
    word_spans: list[tuple[float, float, str]]
    phones: list[tuple[float, float, str]]


def available() -> bool:
    """Return whether Festival is installed."""
    return shutil.which("festival") is not None


def speak() -> list[Spoken]:
    """Return the sentences, spoken by the voice kal_diphone."""
    with tempfile.TemporaryDirectory() as folder:
        bases = [Path(folder, str(index)) for index in range(len(SENTENCES))]
        lines = [f'(speak "{t}" "{b}")\n' for t, b in zip(SENTENCES, bases, strict=True)]
        script = Path(folder, "speak.scm")
        script.write_text(SPEAK + "".join(lines), encoding="utf-8")
        subprocess.run(["festival", "-b", str(script)], check=True, timeout=120)
        return [_spoken(text, base) for text, base in zip(SENTENCES, bases, strict=True)]


def _spoken(text, base):
    """Return what Festival wrote of a sentence."""
    phones = _spans(base.with_suffix(".segs"))
    pauses = {start: end for start, end, name in phones if name == "pau"}
    spans = [
        (pauses.get(start, start), end, name.lower())
        for start, end, name in _spans(base.with_suffix(".words"))
    ]
    samples, _ = sound.read(base.with_suffix(".wav"), RATE)
    return Spoken(samples, re.findall(r"[a-z']+", text.lower()), spans, phones)


def _spans(path):
    """Return the labels of a file that says when each of them ends."""
    rows = [line.split() for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    ends = [0.0, *(float(row[0]) for row in rows)]
    names = [row[2] for row in rows]
    return [(a, b, n) for (a, b), n in zip(itertools.pairwise(ends), names, strict=True)]
