"""`texture.exr`: deviations of the vertices from the neutral as pixels, for materials of engines.

Channels R, G, B are x, y, z; `deviation = offset + gain * pixel`. `normals.exr` is of the same size
and holds `normal * 0.5 + 0.5`, half. The texture's mesh, an OBJ, is the neutral with texture
coordinates that stand on each vertex's pixel of the first frame. Two layouts:

`plain`: row = frame * blocks + block from the top, column = vertex - block * width; the next frame
is `blocks / height` lower. Axes and unit are the character's, of texture and mesh alike.

`openvat`: the layout of the OpenVAT add-on for Blender: sides are powers of two, row = block *
frames + frame, the next frame is `1 / height` lower. Deviations and normals have Blender's axes (z
up, the face along -y), the mesh has y up, as OpenVAT's materials expect.

The JSON holds layout_version, layout, frames, vertices, width, height, blocks, fps_num, fps_den,
first_frame, axes, unit, metres_per_unit, vertex_hash (of the rig), scaling (mode, offset, gain),
bounds (exact least and greatest deviation), quantisation (type, greatest error of each axis and as
a distance, in the unit), lookup and import (what the material and the importer must do). For
`openvat` that stands under `keyface`, beside OpenVAT's own `os-remap` with the exact bounds.
"""

import contextlib
import json
from collections.abc import Callable, Iterator
from pathlib import Path

import Imath
import numpy as np
import OpenEXR

from stages.files import obj_sequence, rig

LAYOUT_VERSION = 1
CHANNELS = ("R", "G", "B")
TYPES = {
    "half": (Imath.PixelType.HALF, "<f2"),
    "float": (Imath.PixelType.FLOAT, "<f4"),
}
IMPORT = [
    "linear colours, not sRGB",
    "no compression, no mip-maps, no scaling to powers of two",
    "clamp at the edges",
    "nearest pixel across; two frames are mixed by reading both",
]


@contextlib.contextmanager
def writer(
    path: str | Path, width: int, height: int, kind: str
) -> Iterator[Callable[[np.ndarray], None]]:
    """Yield a function that appends a row of pixels, a (width, 3) float array.

    Parameters
    ----------
    path : the file
    width, height : pixels; as many rows have to be appended
    kind : `half` or `float`
    """
    number, dtype = TYPES[kind]
    header = OpenEXR.Header(width, height)
    header["channels"] = {name: Imath.Channel(Imath.PixelType(number)) for name in CHANNELS}
    file = OpenEXR.OutputFile(str(path), header)

    def append(row: np.ndarray) -> None:
        planes = {name: row[:, axis].astype(dtype).tobytes() for axis, name in enumerate(CHANNELS)}
        file.writePixels(planes, 1)

    try:
        yield append
    finally:
        file.close()


def write_json(path: str | Path, description: dict, remap: dict | None) -> None:
    """Write the description; `remap` is OpenVAT's own part, None for the plain layout."""
    whole = {"layout_version": LAYOUT_VERSION} | description | {"import": IMPORT}
    document = whole if remap is None else {"os-remap": remap, "keyface": whole}
    Path(path).write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")


def write_mesh(
    path: str | Path, character: rig.Rig, vertices: np.ndarray, places: np.ndarray
) -> None:
    """Write the texture's mesh: vertices (V, 3) and their texture coordinates (V, 2)."""
    lines = [obj_sequence.VERTEX * len(vertices) % tuple(vertices.ravel().tolist())]
    lines.append("vt %.9g %.9g\n" * len(places) % tuple(places.ravel().tolist()))
    lines.append(obj_sequence.face_lines(character.sizes, character.corners, textured=True))
    Path(path).write_text("".join(lines), encoding="utf-8", newline="\n")
