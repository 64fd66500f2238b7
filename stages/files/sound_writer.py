"""Sounds out, through PyAV: 16-bit WAV or FLAC, without dates."""

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import av
import numpy as np

from stages.files import atomic, errors, film, sound_pieces

CODECS = {".wav": "pcm_s16le", ".flac": "flac"}
CONTAINER_OPTIONS = {"fflags": "+bitexact"}
SILENT = (48000, "mono")


def write(path: str | Path, sound: str | Path, tempo: Fraction) -> float:
    """Write the sound of a film or a sound file at a tempo, and return its length [s].

    Raises
    ------
    errors.InputError
        if the sound is not there, empty or cannot be decoded, or the file to write is none of these
        kinds
    """
    codec = CODECS.get(Path(path).suffix.lower())
    if codec is None:
        message = f"sound is written as {' or '.join(CODECS)}: rename it"
        raise errors.InputError(path, message)
    if not Path(sound).is_file():
        raise errors.InputError(sound, "no such sound: check the columns sound and video")
    pieces = sound_pieces.seamless(_pieces(sound))
    if tempo != 1:
        pieces = sound_pieces.at_tempo(pieces, tempo)
    written, rate = 0, 1
    with (
        atomic.replacing(path) as temporary,
        av.open(str(temporary), "w", options=CONTAINER_OPTIONS) as container,
    ):
        stream = None
        for rate, layout, start, planes in pieces:
            if stream is None:
                stream = container.add_stream(codec, rate=rate, layout=layout)
                stream.codec_context.flags |= av.codec.context.Flags.bitexact
            container.mux(stream.encode(_frame(rate, layout, start, planes)))
            written = start + planes.shape[1]
        if stream is None:
            message = "holds no sound from the film's first picture on"
            raise errors.InputError(sound, f"{message}: give one that does, or tempo 1")
        container.mux(stream.encode())
    return written / rate


def _pieces(sound: str | Path) -> Iterator[sound_pieces.Piece]:
    """Yield the sound; of a silent film silence as long as its pictures."""
    empty = True
    for piece in sound_pieces.read(sound):
        empty = False
        yield piece
    if empty:
        rate, layout = SILENT
        seconds = film.last_time(sound) + float(1 / film.nominal_rate(sound))
        yield rate, layout, 0, np.zeros((1, round(seconds * rate)), np.float32)


def _frame(rate: int, layout: str, start: int, planes: np.ndarray) -> av.AudioFrame:
    """Return samples (C, N) as a frame of 16-bit ones, interleaved."""
    whole = np.rint(np.clip(planes, -1.0, 1.0) * 32767).astype(np.int16)
    frame = av.AudioFrame.from_ndarray(
        np.ascontiguousarray(whole.T.reshape(1, -1)), format="s16", layout=layout
    )
    frame.sample_rate, frame.pts, frame.time_base = rate, start, Fraction(1, rate)
    return frame
