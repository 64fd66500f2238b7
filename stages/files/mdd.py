"""MDD point caches: positions of every vertex at times in seconds, for modifiers of other programs.

Big-endian: samples and points as int32, the samples' times as float32 [s], then samples x points x
3 float32. A time is the frame's number over the rate, so the file carries both: the first time is
the first frame's. No topology: the character's own file has that.
"""

import contextlib
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

COUNTS = ">ii"


@contextlib.contextmanager
def writer(
    path: str | Path, vertices: int, time_s: np.ndarray
) -> Iterator[Callable[[np.ndarray], None]]:
    """Yield a function that appends one frame, a (V, 3) float array, for each of (T,) times [s]."""
    with Path(path).open("wb") as stream:
        stream.write(struct.pack(COUNTS, len(time_s), vertices))
        stream.write(np.ascontiguousarray(time_s, ">f4").tobytes())

        def append(positions: np.ndarray) -> None:
            stream.write(np.ascontiguousarray(positions, ">f4").tobytes())

        yield append
