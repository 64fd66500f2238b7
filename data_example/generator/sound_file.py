"""Write a sound as FLAC with the same bytes every time."""

from fractions import Fraction

import av
import numpy as np


def write(path, samples, rate):
    """Write one channel of 16 bits.

    Parameters
    ----------
    path : pathlib.Path
    samples : (S,) float array in -1..1
    rate : int [Hz]
    """
    whole = np.clip(np.round(samples * 32767), -32767, 32767).astype(np.int16)
    with av.open(str(path), "w", options={"fflags": "+bitexact"}) as container:
        stream = container.add_stream("flac", rate=rate, layout="mono")
        stream.options = {"compression_level": "12"}
        block = av.AudioFrame.from_ndarray(whole[None], "s16", "mono")
        block.sample_rate = rate
        block.pts = 0
        block.time_base = Fraction(1, rate)
        container.mux(stream.encode(block))
        container.mux(stream.encode(None))
