"""Films out, through PyAV: H.264 pictures at the times they are given, AAC sound of another film.

One encoder thread and no dates, so that the same pictures give the same bytes.
"""

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np

from stages.files import atomic, sound_pieces

CLOCK_HZ = 90000
VIDEO_OPTIONS = {"preset": "superfast", "crf": "22", "threads": "1"}
CONTAINER_OPTIONS = {"fflags": "+bitexact", "movflags": "+faststart"}
SOUND_BITS_PER_S = 128000
# sound is written this far ahead of the pictures, so that the muxer holds little back
LEAD_S = 0.5
NORMAL = Fraction(1)


def write(
    path: str | Path,
    pictures: Iterable[tuple[float, np.ndarray]],
    size: tuple[int, int],
    rate: Fraction,
    sound_of: str | Path | None = None,
    sound_start_s: float = 0.0,
    tempo: Fraction = NORMAL,
) -> None:
    """Write a film.

    Parameters
    ----------
    path : the film, .mp4
    pictures : time [s] from 0, rising, and (H, W, 3) uint8 RGB picture
    size : W and H, both even
    rate : nominal frames per second
    sound_of : film whose sound to take; None for a silent film
    sound_start_s : time in that film, from its first picture, that is 0 in this one [s]
    tempo : how many seconds of that sound pass in one of this film, at the sound's own pitch

    Raises
    ------
    errors.InputError
        if the sound cannot be decoded
    """
    with (
        atomic.replacing(path) as temporary,
        av.open(str(temporary), "w", options=CONTAINER_OPTIONS) as container,
    ):
        video = container.add_stream("libx264", rate=rate, options=VIDEO_OPTIONS)
        video.width, video.height = size
        video.pix_fmt = "yuv420p"
        video.codec_context.time_base = _time_base(rate)
        sound = _Sound(container, sound_of, sound_start_s, tempo) if sound_of else None
        end = 0.0
        for time_s, picture in pictures:
            if sound:
                sound.advance(time_s + LEAD_S)
            # OpenCV converts four times as fast as the encoder's own scaler
            planes = cv2.cvtColor(np.ascontiguousarray(picture), cv2.COLOR_RGB2YUV_I420)
            frame = av.VideoFrame.from_ndarray(planes, format="yuv420p")
            frame.time_base = _time_base(rate)
            frame.pts = round(time_s / frame.time_base)
            container.mux(video.encode(frame))
            end = time_s + float(1 / rate)
        container.mux(video.encode())
        if sound:
            sound.finish(end)


def _time_base(rate: Fraction) -> Fraction:
    """Return a tick of about 1/90000 s of which a frame of the rate is a whole number."""
    return Fraction(1, rate.numerator * max(1, CLOCK_HZ // rate.numerator))


class _Sound:
    """The sound of a film on its way into another one."""

    def __init__(
        self,
        container: av.container.OutputContainer,
        path: str | Path,
        start_s: float,
        tempo: Fraction,
    ):
        self.container = container
        self.samples = sound_pieces.seamless(sound_pieces.read(path, start_s))
        if tempo != 1:
            self.samples = sound_pieces.at_tempo(self.samples, tempo)
        self.first = next(self.samples, None)
        if self.first is None:
            self.stream = None
            return
        self.rate, self.layout = self.first[0], self.first[1]
        self.stream = container.add_stream("aac", rate=self.rate, layout=self.layout)
        self.stream.bit_rate = SOUND_BITS_PER_S
        self.written = 0

    def advance(self, until_s: float) -> None:
        """Write what sounds before a time."""
        while self.first is not None and self.written < until_s * self.rate:
            planes = np.ascontiguousarray(self.first[3])
            frame = av.AudioFrame.from_ndarray(planes, format="fltp", layout=self.layout)
            frame.sample_rate, frame.pts = self.rate, self.written
            frame.time_base = Fraction(1, self.rate)
            self.written += planes.shape[1]
            self.container.mux(self.stream.encode(frame))
            self.first = next(self.samples, None)

    def finish(self, end_s: float) -> None:
        """Write the rest, not longer than the pictures."""
        if self.stream is None:
            return
        self.advance(end_s)
        self.container.mux(self.stream.encode())
