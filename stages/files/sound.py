"""Sounds in, through PyAV: mono samples of any sound or film, and when they start.

Sounds of a film are placed on the film's clock, whose 0 is its first picture.
"""

import itertools
from collections.abc import Iterator
from pathlib import Path

import av
import numpy as np

from stages.files import errors

# presentation times are rounded, to 1 ms in Matroska; what is off by more is a pause or an overlap
TOLERANCE_S = 0.003
GREATEST_JUMP_S = 600.0


def read(path: str | Path, rate: int) -> tuple[np.ndarray, float]:
    """Return the first sound of a file, its channels averaged, and when it starts.

    Pauses in the presentation times become silence, overlaps are cut.

    Parameters
    ----------
    path : a sound, or a film with sound
    rate : samples per second that are wanted

    Returns
    -------
    samples : (N,) float32 array, 1 is full scale
    start_s : time of the first sample [s], from the film's first picture; 0 in a sound file

    Raises
    ------
    errors.InputError
        if there is no such file, no sound in it, or its sound cannot be decoded
    """
    if not Path(path).is_file():
        raise errors.InputError(path, "no such sound: check the columns sound and video")
    try:
        with av.open(str(path)) as container:
            if not container.streams.audio:
                message = "has no sound: give one with sound, or set sync_offset_s in shots.tsv"
                raise errors.InputError(path, message)
            samples, start = _joined(path, _decoded(container, rate), rate)
        first = first_picture(path)
    # what PyAV refuses itself, such as a change of channels, is a plain ValueError
    except (av.error.FFmpegError, ValueError) as error:
        if isinstance(error, errors.InputError):
            raise
        reason = getattr(error, "strerror", None) or error
        message = f"its sound cannot be decoded ({reason}): export it again, as WAV"
        raise errors.InputError(path, message) from error
    return samples, 0.0 if first is None else start - first


def _decoded(
    container: av.container.InputContainer, rate: int
) -> Iterator[tuple[float | None, np.ndarray]]:
    """Yield time [s], None where unknown, and (N,) float32 samples of every piece of the sound."""
    stream = container.streams.audio[0]
    resampler = av.AudioResampler("fltp", None, rate)
    # None at the end fetches what the resampler holds back
    for frame in itertools.chain(container.decode(stream), [None]):
        for part in resampler.resample(frame):
            yield part.time, part.to_ndarray().mean(axis=0)


def _joined(
    path: str | Path, pieces: Iterator[tuple[float | None, np.ndarray]], rate: int
) -> tuple[np.ndarray, float]:
    """Return the pieces as one (N,) float32 array, and the time of its first sample [s]."""
    parts, count, start = [], 0, None
    for time, samples in pieces:
        if start is None:
            start = time or 0.0
        gap = 0 if time is None else round((time - start) * rate) - count
        if abs(gap) > GREATEST_JUMP_S * rate:
            message = f"times of its sound jump by {gap / rate:.0f} s after {count / rate:.2f} s"
            raise errors.InputError(path, message + ": export it again, as WAV")
        if gap > TOLERANCE_S * rate:
            parts.append(np.zeros(gap, np.float32))
        part = samples[-gap:] if gap < -TOLERANCE_S * rate else samples
        parts.append(part)
        count += len(part) + (gap if gap > TOLERANCE_S * rate else 0)
    if count == 0:
        raise errors.InputError(path, "its sound is empty: export it again, as WAV")
    joined = np.concatenate(parts)
    if not np.isfinite(joined).all():
        raise errors.InputError(path, "its sound holds samples that are no numbers: export it anew")
    return joined, start


def first_picture(path: str | Path) -> float | None:
    """Return the presentation time of a film's first picture [s]; None where there is no film.

    The cover of a song is not a film.
    """
    with av.open(str(path)) as container:
        streams = [
            stream
            for stream in container.streams.video
            if not stream.disposition & av.stream.Disposition.attached_pic
        ]
        times = (frame.time for frame in container.decode(streams[0])) if streams else iter(())
        return next((time for time in times if time is not None), None)
