"""`mesh.exr`: float32 vertex positions as a picture, and the JSON beside it that says how.

Channels R, G, B hold x, y, z in the character's own unit and axes. Row = frame * blocks + block,
column = vertex - block * width; block = vertex // width. What is left of the last block repeats
the frame's last vertex, so that the picture has no values outside the bounds. `mesh.json` holds:

layout_version, frames, vertices, width, blocks, fps_num, fps_den, first_frame (its time is
first_frame * fps_den / fps_num seconds after the film's first picture), axes (up, and the
file's own right-handed x, y, z as R, G, B), unit, metres_per_unit, bounds (exact minimum and
maximum over all frames), quantisation (type and greatest rounding error, in the unit) and
vertex_hash (sha256 over the neutral's float32 positions and its polygons).
"""

import contextlib
import json
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path

import Imath
import numpy as np
import OpenEXR

from stages.files import errors

LAYOUT_VERSION = 1
MAX_WIDTH = 8192
CHANNELS = ("R", "G", "B")
CHUNK_FRAMES = 32
FLOAT32_ROUNDING = 2.0**-24
COUNTS = ("frames", "vertices", "width", "blocks", "fps_num", "fps_den")
PIXEL_BYTES = 12
MOST_PACKED = 1100  # to one: what the compression can do at most


def layout(vertices: int, max_width: int = MAX_WIDTH) -> tuple[int, int]:
    """Return width and blocks: the fewest blocks that fit, then the narrowest rows."""
    blocks = -(-vertices // max_width)
    return -(-vertices // blocks), blocks


@contextlib.contextmanager
def writer(
    path: str | Path, vertices: int, frames: int, max_width: int = MAX_WIDTH
) -> Iterator[Callable[[np.ndarray], None]]:
    """Yield a function that appends one frame, a (V, 3) float array."""
    width, blocks = layout(vertices, max_width)
    file = OpenEXR.OutputFile(str(path), OpenEXR.Header(width, frames * blocks))
    # beyond the last vertex the index stays on it
    places = np.minimum(np.arange(width * blocks), vertices - 1)

    def append(positions: np.ndarray) -> None:
        rows = np.asarray(positions, np.float32)[places]
        planes = {name: rows[:, axis].tobytes() for axis, name in enumerate(CHANNELS)}
        file.writePixels(planes, blocks)

    try:
        yield append
    finally:
        file.close()


def write_json(
    path: str | Path,
    vertices: int,
    frames: int,
    first_frame: int,
    rate: Fraction,
    bounds: np.ndarray,
    form: dict,
    max_width: int = MAX_WIDTH,
) -> None:
    """Write the description of a baked mesh.

    Parameters
    ----------
    path : the file
    vertices, frames, first_frame : counts, and the number of the first frame
    rate : frames per second
    bounds : (2, 3) float array, minimum and maximum over the take [character's unit]
    form : the character's `axes`, `unit`, `metres_per_unit` and `vertex_hash`
    max_width : widest row
    """
    width, blocks = layout(vertices, max_width)
    error = float(np.abs(bounds).max() * FLOAT32_ROUNDING)
    description = {
        "layout_version": LAYOUT_VERSION,
        "frames": frames,
        "vertices": vertices,
        "width": width,
        "blocks": blocks,
        "fps_num": Fraction(rate).numerator,
        "fps_den": Fraction(rate).denominator,
        "first_frame": first_frame,
        "bounds": {"min": bounds[0].tolist(), "max": bounds[1].tolist()},
        "quantisation": {"type": "float32", "max_error": error},
    } | form
    Path(path).write_text(json.dumps(description, indent=2) + "\n", encoding="utf-8")


def read_json(path: str | Path) -> dict:
    """Read the description of a baked mesh.

    Raises
    ------
    errors.InputError
        if the file is none, or of another layout, or its counts do not fit together
    """
    try:
        description = json.loads(Path(path).read_text(encoding="utf-8"))
    except (json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise errors.InputError(path, f"no JSON: {error}; bake the take again") from error
    found = description.get("layout_version") if isinstance(description, dict) else None
    if found != LAYOUT_VERSION:
        message = f"layout version {found} in place of {LAYOUT_VERSION}: bake the take again"
        raise errors.InputError(path, message)
    for name in (*COUNTS, "first_frame"):
        value = description.get(name)
        if type(value) is not int or (name in COUNTS and value < 1):
            raise errors.InputError(path, f"{name} is '{value}', no count: bake the take again")
    width, blocks = description["width"], description["blocks"]
    if not (width - 1) * blocks < description["vertices"] <= width * blocks:
        raise errors.InputError(path, "its rows do not fit its vertices: bake the take again")
    return description


def check_rig(path: str | Path, description: dict, vertex_hash: str) -> None:
    """Refuse the description of a mesh that was baked from another rig.

    Raises
    ------
    errors.InputError
        if the hashes of neutral and polygons differ
    """
    if description.get("vertex_hash") != vertex_hash:
        raise errors.InputError(path, "was baked from another rig: bake the take again")


class Reader:
    """Baked positions, read a frame at a time.

    Parameters
    ----------
    path : the EXR file
    description : what `read_json` gave
    """

    def __init__(self, path: str | Path, description: dict):
        self.vertices, self.blocks = description["vertices"], description["blocks"]
        self.frames, self.first_frame = description["frames"], description["first_frame"]
        self.rate = Fraction(description["fps_num"], description["fps_den"])
        known = description.get("start_timecode")
        self.start = {"start_timecode": known} if isinstance(known, str) else {}
        try:
            self._file = OpenEXR.InputFile(str(path))
        except OSError as error:
            raise errors.InputError(path, f"no EXR file ({error}): bake again") from error
        self._start, self._chunk = -1, np.zeros((0, 0, 3), np.float32)
        window = self._file.header()["dataWindow"]
        rows, width = window.max.y + 1, window.max.x + 1
        if (rows, width) != (self.frames * self.blocks, description["width"]):
            message = f"is {width} x {rows} in place of what its JSON says: bake the take again"
            raise errors.InputError(path, message)
        if PIXEL_BYTES * rows * width > MOST_PACKED * Path(path).stat().st_size:
            message = f"is too short to hold {width} x {rows} pixels: bake the take again"
            raise errors.InputError(path, message)
        self._path = path

    @property
    def time_s(self) -> np.ndarray:
        """The times of the frames (T,), from the film's first picture on [s]."""
        numbers = self.first_frame + np.arange(self.frames)
        return numbers * self.rate.denominator / self.rate.numerator

    def nearest(self, time_s: float) -> int:
        """Return the frame, counted from 0, that plays at a time [s]; the ends are held."""
        return min(max(round(time_s * self.rate) - self.first_frame, 0), self.frames - 1)

    def frame(self, index: int) -> np.ndarray:
        """Return the (V, 3) float32 positions of a frame, counted from 0."""
        start = index - index % CHUNK_FRAMES
        if start != self._start:
            self._start, self._chunk = start, self._read(start)
        return self._chunk[index - start]

    def _read(self, start: int) -> np.ndarray:
        """Return some frames: rows are compressed together, so one at a time would be slow."""
        end = min(start + CHUNK_FRAMES, self.frames)
        kind = Imath.PixelType(Imath.PixelType.FLOAT)
        rows = start * self.blocks, end * self.blocks - 1
        try:
            planes = [np.frombuffer(self._file.channel(n, kind, *rows), "<f4") for n in CHANNELS]
        except (OSError, TypeError) as error:
            message = f"breaks off or is damaged by frame {start} ({error}): bake the take again"
            raise errors.InputError(self._path, message) from error
        chunk = np.stack(planes, axis=1).reshape(end - start, -1, 3)
        return np.ascontiguousarray(chunk[:, : self.vertices])
