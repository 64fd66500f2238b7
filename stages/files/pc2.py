"""PC2 point caches: positions of every vertex at every frame, for modifiers of other programs.

Little-endian: `POINTCACHE2` and a zero byte, version 1, points, start frame, frames a sample,
samples; then samples x points x 3 float32. No topology: the character's own file has that.
"""

import contextlib
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

HEADER = "<12siiffi"
MAGIC = b"POINTCACHE2\0"


@contextlib.contextmanager
def writer(
    path: str | Path, vertices: int, frames: int, first_frame: int
) -> Iterator[Callable[[np.ndarray], None]]:
    """Yield a function that appends one frame, a (V, 3) float array."""
    with Path(path).open("wb") as stream:
        stream.write(struct.pack(HEADER, MAGIC, 1, vertices, float(first_frame), 1.0, frames))

        def append(positions: np.ndarray) -> None:
            stream.write(np.ascontiguousarray(positions, "<f4").tobytes())

        yield append
