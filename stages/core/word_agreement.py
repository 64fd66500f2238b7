"""How well words fit the sound that they were placed in: their scores, together and by passage.

A phone's score is the natural logarithm of its likelihood per frame, against the best of the
sounds that compete there; the agreement of many is the mean over the frames of speech.
"""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

from stages.core import forced_alignment

# mean score of speech [nats a frame]: below the first other words are spoken, below the second
# that is in doubt; `python -m bench.phone_trial` shows both on right and on wrong words
OTHER_WORDS, DOUBTFUL = -4.4, -4.0
# fewer sounds compete where every word is searched by itself, between known times
DOUBTFUL_TIMED = -3.0
WORDS_TOGETHER = 8


class Passage(NamedTuple):
    """Words that follow each other, when they start [s], and their agreement [nats per frame]."""

    words: list[str]
    start_s: float
    agreement: float


def agreement(segments: Sequence[forced_alignment.Segment]) -> float:
    """Return the mean score over the frames of speech [nats per frame]; NaN without any."""
    known = [(s.end_s - s.start_s, s.score) for s in segments if s.word and math.isfinite(s.score)]
    total = sum(duration for duration, _ in known)
    return sum(duration * score for duration, score in known) / total if total else math.nan


def worst_passage(
    segments: Sequence[forced_alignment.Segment], count: int = WORDS_TOGETHER
) -> Passage:
    """Return the words that fit least, that many together, or all if there are fewer.

    Parameters
    ----------
    segments : phones in the order of time, some with a word and a score
    count : number of words

    Returns
    -------
    passage : the one of least agreement

    Raises
    ------
    ValueError
        if no phone has a word and a score
    """
    known = [segment for segment in segments if segment.word and math.isfinite(segment.score)]
    words = [list(group) for _, group in itertools.groupby(known, lambda segment: segment.word)]
    if not words:
        raise ValueError(f"none of {len(segments)} phones has a word and a score")
    passages = []
    for first in range(max(len(words) - count, 0) + 1):
        own = words[first : first + count]
        value = agreement([segment for word in own for segment in word])
        passages.append(Passage([word[0].word for word in own], own[0][0].start_s, value))
    return min(passages, key=lambda passage: passage.agreement)
