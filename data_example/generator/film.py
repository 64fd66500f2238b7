"""Write a film with sound: H.264 and AAC in MP4, one thread, the same bytes every time."""

from fractions import Fraction

import av
import numpy as np

from data_example.generator import shots, sound

CRF = "18"
NOISE = 1.3 / 255


def noisy(picture, seed, frame):
    """Return a picture with camera noise as 8-bit RGB; brighter pixels are noisier."""
    rng = np.random.default_rng([seed, frame])
    grain = rng.standard_normal((*picture.shape[:2], 1), dtype=np.float32)
    colour = 0.4 * rng.standard_normal(picture.shape, dtype=np.float32)
    strength = NOISE * (0.7 + 0.6 * picture.mean(axis=2, keepdims=True))
    return np.clip((picture + strength * (grain + colour)) * 255 + 0.5, 0, 255).astype(np.uint8)


def _write_sound(container, stream, samples):
    """Encode the whole sound track."""
    whole = np.clip(samples * 32767, -32767, 32767).astype(np.int16)
    for start in range(0, len(whole), 1024):
        block = av.AudioFrame.from_ndarray(whole[None, start : start + 1024], "s16", "mono")
        block.sample_rate = sound.RATE
        block.pts = start
        block.time_base = Fraction(1, sound.RATE)
        container.mux(stream.encode(block))
    container.mux(stream.encode(None))


def write(path, pictures, samples, crf=CRF, bit_rate=64000):
    """Write pictures and sound.

    Parameters
    ----------
    path : pathlib.Path
    pictures : iterable of (H, W, 3) uint8 arrays
    samples : (S,) float32 array at sound.RATE
    crf : str, quality of the picture, less is better
    bit_rate : int, of the sound [bit/s]
    """
    with av.open(str(path), "w", options={"fflags": "+bitexact"}) as container:
        picture_stream = container.add_stream("libx264", rate=shots.RATE)
        picture_stream.pix_fmt = "yuv420p"
        picture_stream.options = {"crf": crf, "preset": "slow", "threads": "1", "tune": "animation"}
        sound_stream = container.add_stream("aac", rate=sound.RATE, layout="mono")
        sound_stream.bit_rate = bit_rate
        for number, picture in enumerate(pictures):
            if number == 0:
                picture_stream.height, picture_stream.width = picture.shape[:2]
            frame = av.VideoFrame.from_ndarray(picture, "rgb24")
            frame.pts = number
            frame.time_base = Fraction(1, shots.RATE)
            container.mux(picture_stream.encode(frame))
        container.mux(picture_stream.encode(None))
        _write_sound(container, sound_stream, samples)
