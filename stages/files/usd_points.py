"""`points.usdc`: a take as points of a mesh at every frame, with the box round them."""

import contextlib
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import rig, usd

FACE = f"{usd.ROOT}/face"
# what is held in memory until it is written to the file
HELD_BYTES = 128 << 20


@contextlib.contextmanager
def writer(
    path: str | Path,
    character: rig.Rig,
    frame: np.ndarray,
    rate: Fraction,
    start: Mapping[str, str] | None = None,
) -> Iterator[Callable[[np.ndarray], None]]:
    """Yield a function that appends one frame, a (V, 3) float array, for each of (T,) frames."""
    numbers = iter(map(float, frame))
    often = max(1, HELD_BYTES // character.neutral.nbytes)
    with usd.stage(path, character, frame, rate, start) as made:
        face = usd.mesh(made, FACE, character)
        points, extent = face.GetPointsAttr(), face.GetExtentAttr()

        def append(positions: np.ndarray) -> None:
            number = next(numbers)
            points.Set(usd.vectors(positions), number)
            extent.Set(usd.extent(positions), number)
            if int(number) % often == 0:
                usd.save(made, path)

        yield append
