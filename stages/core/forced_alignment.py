"""Place the phones of known words in a sound: forced alignment by hidden Markov models.

The models, their dictionary (US English) and the search are PocketSphinx's. Words are placed
first, then the phones within each word. A score is the natural logarithm of the likelihood per
frame, against the best of the sounds that compete there: 0 is the best, other words score low.
"""

import itertools
import math
import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pocketsphinx

RATE = 16000
FRAME_S = 0.01
WINDOW_S = 0.0256
# PocketSphinx counts likelihoods in powers of 1.0001, and drops ten bits of their logarithm
NATS = 1024 * math.log(1.0001)
# wider than by default, so that noise does not lose the way; searching the best path again would
# end some sounds in words of one frame, too short for their phones; pauses as likely as none, for
# a first stop is else stretched over the silence before it
SEARCH = {"beam": 1e-100, "pbeam": 1e-100, "wbeam": 1e-90, "bestpath": False, "silprob": 1.0}
PEAK = 0.9
SILENT = 1e-4
# long sounds are cut in silences: the phone step keeps phones times frames, and more sounds of a
# piece compete the longer it is
PIECE_S, SHORTEST_PIECE_S, SHORTEST_SILENCE_S = 10.0, 3.0, 0.1
SILENCE, UNKNOWN = "pau", "spn"
FILLERS = {"SIL": SILENCE, "+NSN+": SILENCE, "+SPN+": UNKNOWN}
VARIANT = re.compile(r"\(\d+\)$")


class Segment(NamedTuple):
    """A phone: the time that it spans [s], its word (blank in silence), and its score [nats]."""

    start_s: float
    end_s: float
    phone: str
    word: str
    score: float


class NotAlignedError(ValueError):
    """The words cannot be placed in the sound."""


def unknown_words(words: Sequence[str]) -> list[str]:
    """Return the words that the dictionary lacks, each once, in their order."""
    decoder = _decoder()
    return [word for word in dict.fromkeys(words) if decoder.lookup_word(word) is None]


def align(samples: np.ndarray, words: Sequence[str]) -> list[Segment]:
    """Place words and their phones in a sound.

    Parameters
    ----------
    samples : (N,) float array, -1..1, at RATE
    words : what is spoken, each word known to the dictionary

    Returns
    -------
    segments : phones in the order of time, from the start of the sound to its end

    Raises
    ------
    NotAlignedError
        if the words find no place in the sound
    ValueError
        if the sound is silent
    """
    sound = _as_int16(samples)
    decoder = _decoder()
    pieces = [(0, len(sound), list(words))]
    if len(sound) > PIECE_S * RATE:
        pieces = _pieces(len(sound), _placed_words(decoder, sound, words))
    segments: list[Segment] = []
    for first, last, spoken in pieces:
        found = _placed_phones(decoder, sound[first:last], spoken)
        segments += _moved(found, first / RATE, last / RATE)
    return _without_double_silence(segments)


def align_spans(samples: np.ndarray, spans: Sequence[tuple[float, float, str]]) -> list[Segment]:
    """Place the phones of words whose times are known, each word by itself.

    A word that is too short for its phones, three frames each, is divided evenly among them.

    Parameters
    ----------
    samples : (N,) float array, -1..1, at RATE
    spans : start [s], end [s] and word, in the order of time

    Returns
    -------
    segments : phones in the order of time, with silence between words

    Raises
    ------
    ValueError
        if the sound is silent
    """
    sound = _as_int16(samples)
    decoder = _decoder(fsgusefiller=False)
    length = len(sound) / RATE
    segments, end = [], 0.0
    for start, stop, word in spans:
        if start > end:
            segments.append(Segment(end, start, SILENCE, "", math.nan))
        piece = sound[round(start * RATE) : round((stop + WINDOW_S - FRAME_S) * RATE)]
        try:
            found = _moved(_placed_phones(decoder, piece, [word]), start, stop)
        except NotAlignedError:
            found = _evenly(decoder.lookup_word(word).split(), word, start, stop)
        segments += found
        end = stop
    if end < length:
        segments.append(Segment(end, length, SILENCE, "", math.nan))
    return segments


def _decoder(**options: object) -> pocketsphinx.Decoder:
    """Return a decoder with the models of the package; nothing of it is random."""
    return pocketsphinx.Decoder(lm=None, loglevel="FATAL", **SEARCH, **options)


def _as_int16(samples: np.ndarray) -> np.ndarray:
    """Return a sound as 16-bit integers, as loud as they can hold."""
    peak = float(np.abs(samples).max(initial=0.0))
    if peak < SILENT:
        raise ValueError("the sound is silent")
    return np.round(samples * (PEAK * 32767 / peak)).astype("<i2")


def _run(decoder: pocketsphinx.Decoder, sound: np.ndarray) -> None:
    """Run the decoder's search over a whole sound."""
    decoder.start_utt()
    decoder.process_raw(sound.tobytes(), full_utt=True)
    decoder.end_utt()


def _placed_words(
    decoder: pocketsphinx.Decoder, sound: np.ndarray, words: Sequence[str]
) -> list[tuple[str, float, float]]:
    """Return words and fillers (blank) with their times [s]."""
    decoder.set_align_text(" ".join(words))
    _run(decoder, sound)
    placed = []
    for segment in decoder.seg() if decoder.hyp() else ():
        filler = segment.word[0] in "<[("
        name = "" if filler else VARIANT.sub("", segment.word)
        placed.append((name, segment.start_frame * FRAME_S, (segment.end_frame + 1) * FRAME_S))
    if [word for word, _, _ in placed if word] != list(words):
        raise NotAlignedError("the words find no place in the sound")
    return placed


def _placed_phones(
    decoder: pocketsphinx.Decoder, sound: np.ndarray, words: Sequence[str]
) -> list[Segment]:
    """Return the phones of words in a sound, from its first frame to its last."""
    try:
        _placed_words(decoder, sound, words)
        decoder.set_alignment()
        _run(decoder, sound)
        alignment = decoder.get_alignment()
    except RuntimeError as error:
        raise NotAlignedError("the words find no place in the sound") from error
    segments = []
    for word in alignment:
        for phone in word:
            name = FILLERS.get(phone.name, phone.name.lower())
            spoken = "" if phone.name in FILLERS else VARIANT.sub("", word.name)
            start, end = phone.start * FRAME_S, (phone.start + phone.duration) * FRAME_S
            score = NATS * phone.score / phone.duration
            segments.append(Segment(start, end, name, spoken, score))
    return segments


def _pieces(
    length: int, placed: Sequence[tuple[str, float, float]]
) -> list[tuple[int, int, list[str]]]:
    """Cut a long sound in its silences: first and last sample of each piece, and its words."""
    long = [(b - a, (a + b) / 2) for w, a, b in placed if not w and b - a >= SHORTEST_SILENCE_S]
    cuts, end = [0.0], length / RATE
    while end - cuts[-1] > PIECE_S:
        ahead = [(d, at) for d, at in long if cuts[-1] + SHORTEST_PIECE_S < at < end]
        near = [(d, at) for d, at in ahead if at <= cuts[-1] + PIECE_S]
        if not ahead:
            break
        cuts.append((max(near) if near else ahead[0])[1])
    pieces = []
    for start, stop in itertools.pairwise([*cuts, end]):
        spoken = [word for word, a, _ in placed if word and start <= a < stop]
        pieces.append((round(start * RATE), round(stop * RATE), spoken))
    return pieces


def _moved(segments: Sequence[Segment], start: float, end: float) -> list[Segment]:
    """Return segments that begin at a time and last until another one [s]."""
    moved = [s._replace(start_s=s.start_s + start, end_s=s.end_s + start) for s in segments]
    return [*moved[:-1], moved[-1]._replace(end_s=end)]


def _evenly(phones: Sequence[str], word: str, start: float, end: float) -> list[Segment]:
    """Divide the time of a word among its phones."""
    times = np.linspace(start, end, len(phones) + 1).tolist()
    spans = zip(phones, itertools.pairwise(times), strict=True)
    return [Segment(a, b, phone.lower(), word, math.nan) for phone, (a, b) in spans]


def _without_double_silence(segments: Sequence[Segment]) -> list[Segment]:
    """Join silences that follow each other."""
    joined: list[Segment] = []
    for segment in segments:
        if joined and segment.phone == joined[-1].phone == SILENCE:
            joined[-1] = joined[-1]._replace(end_s=segment.end_s)
        else:
            joined.append(segment)
    return joined
