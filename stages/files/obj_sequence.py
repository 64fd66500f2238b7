"""A folder of numbered OBJ files, one a frame: `frame_0012.obj`, and `take.json` beside them.

A file's number is that of its frame, whose time is number * fps_den / fps_num seconds. Vertices
and polygons are the character's own, in its order, unit and axes. `take.json` holds fps_num,
fps_den, first_frame, frames, unit, metres_per_unit, up_axis and vertex_hash.
"""

import json
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import rig

VERTEX = "v %.9g %.9g %.9g\n"  # nine digits give every float32 back


def writer(folder: Path, character: rig.Rig, last_frame: int) -> Callable[[int, np.ndarray], None]:
    """Return a function that writes one frame: its number and (V, 3) float array.

    Names have as many digits as the last one needs, at least four, so that they sort.
    """
    digits = max(4, len(str(last_frame)))
    lines = VERTEX * len(character.neutral)
    faces = face_lines(character.sizes, character.corners)

    def write(frame: int, positions: np.ndarray) -> None:
        text = f"# frame {frame}, {character.unit}, {character.up_axis} up\n"
        text += lines % tuple(np.asarray(positions, float).ravel().tolist()) + faces
        (folder / f"frame_{frame:0{digits}d}.obj").write_text(text, encoding="utf-8", newline="\n")

    return write


def face_lines(sizes: np.ndarray, corners: np.ndarray, textured: bool = False) -> str:
    """Return the lines of polygons; `textured` names a texture coordinate for each vertex."""
    ends = np.cumsum(sizes)
    words = [f"{index}/{index}" if textured else str(index) for index in (corners + 1).tolist()]
    return "".join(
        f"f {' '.join(words[end - size : end])}\n" for end, size in zip(ends, sizes, strict=True)
    )


def write_json(
    path: Path,
    character: rig.Rig,
    first_frame: int,
    frames: int,
    rate: Fraction,
    start: Mapping[str, str],
) -> None:
    """Write the clock and form of a sequence."""
    description = {
        "fps_num": rate.numerator,
        "fps_den": rate.denominator,
        "first_frame": first_frame,
        "frames": frames,
        "unit": character.unit,
        "metres_per_unit": rig.METRES[character.unit],
        "up_axis": character.up_axis,
        "vertex_hash": rig.vertex_hash(character),
        **start,
    }
    path.write_text(json.dumps(description, indent=2) + "\n", encoding="utf-8")
