"""Sounds piece by piece, as long films need: decoded, made seamless, and played at another tempo.

A piece is sampling rate, channel layout (`mono` or `stereo`), number of its first sample, and
(C, N) float32 samples.
"""

import math
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path

import av
import av.filter
import numpy as np

from stages.files import errors, sound

Piece = tuple[int, str, int, np.ndarray]
# what AAC can hold; other sound is brought to the last
RATES = (8000, 11025, 12000, 16000, 22050, 24000, 32000, 44100, 48000)
# one filter changes the tempo by so much at most
MOST = 2.0
# the filter's windows: at least 1/24 s, a power of two samples
WINDOWS_PER_S = 24
BLOCK = 4096


def read(path: str | Path, start_s: float = 0.0) -> Iterator[Piece]:
    """Yield the sound of a file; sample 0 sounds `start_s` after a film's first picture.

    Nothing comes from a silent film.

    Raises
    ------
    errors.InputError
        if the sound cannot be decoded
    """
    try:
        with av.open(str(path)) as container:
            if not container.streams.audio:
                return
            origin = (sound.first_picture(path) or 0.0) + start_s
            stream = container.streams.audio[0]
            layout = "mono" if stream.channels == 1 else "stereo"
            rate = stream.rate if stream.rate in RATES else RATES[-1]
            resampler = av.AudioResampler("fltp", layout, rate)
            for frame in container.decode(stream):
                for part in resampler.resample(frame):
                    start = round((part.time - origin) * part.sample_rate)
                    yield part.sample_rate, layout, start, part.to_ndarray()
    except av.error.FFmpegError as error:
        message = f"its sound cannot be decoded ({error.strerror}): export it again"
        raise errors.InputError(path, message) from error


def seamless(pieces: Iterable[Piece]) -> Iterator[Piece]:
    """Yield pieces that follow each other from sample 0: gaps are silence, overlaps cut off."""
    written = 0
    for rate, layout, start, planes in pieces:
        rest = planes[:, max(written - start, 0) :]
        rest = np.pad(rest, ((0, 0), (max(start - written, 0), 0)))
        if rest.shape[1]:
            yield rate, layout, written, rest
            written += rest.shape[1]


def at_tempo(pieces: Iterable[Piece], tempo: Fraction) -> Iterator[Piece]:
    """Play a seamless sound at another tempo and at its own pitch.

    FFmpeg's `atempo` (overlapping windows, joined where they are alike), several in a row beyond a
    factor of two. Each comes a quarter of its window early: silence before the sound makes up for
    that. The result is as long as the sound over the tempo.

    Parameters
    ----------
    pieces : from `seamless`
    tempo : seconds of the sound that pass in one second
    """
    waiting = iter(pieces)
    first = next(waiting, None)
    if first is None:
        return
    rate, layout = first[0], first[1]
    graph, late = _graph(rate, layout, tempo)
    planes = np.zeros((len(first[3]), late), np.float32)
    taken, given, count = 0, 0, 0
    for piece in _chained((rate, layout, 0, planes), first, waiting):
        count += piece[3].shape[1]
        for begin in range(0, piece[3].shape[1], BLOCK):
            graph.push(_frame(rate, layout, taken, piece[3][:, begin : begin + BLOCK]))
            taken += min(BLOCK, piece[3].shape[1] - begin)
            for found in _pulled(graph):
                yield rate, layout, given, found
                given += found.shape[1]
    graph.push(None)
    whole = round((count - late) / tempo)
    for found in _pulled(graph):
        rest = found[:, : max(whole - given, 0)]
        if rest.shape[1]:
            yield rate, layout, given, rest
            given += rest.shape[1]
    if given < whole:
        yield rate, layout, given, np.zeros((len(planes), whole - given), np.float32)


def factors(tempo: Fraction) -> list[float]:
    """Return the tempos of filters in a row, each within a factor of two."""
    count = max(1, math.ceil(abs(math.log2(tempo)) / math.log2(MOST) - 1e-9))
    return [float(tempo) ** (1.0 / count)] * count


def _graph(rate: int, layout: str, tempo: Fraction) -> tuple[av.filter.Graph, int]:
    """Return the filters, and how many samples of silence they need before the sound."""
    graph = av.filter.Graph()
    last = graph.add_abuffer(
        sample_rate=rate, format="fltp", layout=layout, time_base=Fraction(1, rate)
    )
    window = 2 ** math.ceil(math.log2(rate // WINDOWS_PER_S))
    late, passed = 0.0, 1.0
    for factor in factors(tempo):
        node = graph.add("atempo", f"{factor:.12f}")
        last.link_to(node)
        last = node
        late += passed * window / 4
        passed *= factor
    # the filter gives its channels interleaved
    planar = graph.add("aformat", "sample_fmts=fltp")
    last.link_to(planar)
    planar.link_to(graph.add("abuffersink"))
    graph.configure()
    return graph, round(late)


def _chained(silence: Piece, first: Piece, rest: Iterable[Piece]) -> Iterator[Piece]:
    """Yield all pieces in order."""
    yield silence
    yield first
    yield from rest


def _frame(rate: int, layout: str, start: int, planes: np.ndarray) -> av.AudioFrame:
    """Return samples as a frame."""
    frame = av.AudioFrame.from_ndarray(
        np.ascontiguousarray(planes, np.float32), format="fltp", layout=layout
    )
    frame.sample_rate, frame.pts, frame.time_base = rate, start, Fraction(1, rate)
    return frame


def _pulled(graph: av.filter.Graph) -> Iterator[np.ndarray]:
    """Yield what the filters have ready."""
    while True:
        try:
            yield graph.pull().to_ndarray()
        except (av.error.BlockingIOError, av.error.EOFError):
            return
