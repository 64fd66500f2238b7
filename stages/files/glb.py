"""GLB containers: the document by pygltflib, the binary chunk by checked access.

Nothing is allocated by what the file claims: every count and place is held against the bytes that
are there. Only what is needed to read geometry is understood.
"""

import dataclasses
import struct
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pygltflib as gltf

from stages.files import errors

MAGIC, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
DTYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {gltf.SCALAR: 1, gltf.VEC2: 2, gltf.VEC3: 3, gltf.VEC4: 4}
COMPRESSED = {
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
    "KHR_draco_mesh_compression": "Draco",
}
AGAIN = "export it again"


@dataclasses.dataclass(frozen=True)
class Glb:
    """An open file.

    Attributes
    ----------
    path : where it came from
    document : its JSON
    binary : its binary chunk
    """

    path: Path
    document: gltf.GLTF2
    binary: bytes


def read(path: str | Path) -> Glb:
    """Read a GLB file of version 2.

    Raises
    ------
    errors.InputError
        if it is none, is cut short, or is compressed
    """
    path = Path(path)
    if not path.is_file():
        raise errors.InputError(path, "no such file: save it under this name, or correct the name")
    data = path.read_bytes()
    head = struct.unpack("<III", data[:12]) if len(data) >= 12 else (0, 0, 0)
    if head[0] != MAGIC or head[1] != 2:
        raise errors.InputError(path, "is no GLB file of version 2: export it as glTF binary")
    if head[2] > len(data):
        message = f"is cut short: it claims {head[2]} bytes and has {len(data)}"
        raise errors.InputError(path, f"{message}: copy or {AGAIN}")
    chunks = _chunks(path, data[: head[2]])
    if JSON_CHUNK not in chunks:
        raise errors.InputError(path, f"holds no JSON chunk: {AGAIN}")
    try:
        document = gltf.GLTF2.gltf_from_json(chunks[JSON_CHUNK].decode("utf-8"))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
        raise errors.InputError(path, f"its JSON chunk is no glTF document: {AGAIN}") from error
    for name in document.extensionsRequired or []:
        refuse_compressed(path, {str(name): None})
    return Glb(path, document, chunks.get(BINARY_CHUNK, b""))


def _chunks(path: Path, data: bytes) -> dict[int, bytes]:
    """Return the first chunk of each kind."""
    found, place = {}, 12
    while place + 8 <= len(data):
        size, kind = struct.unpack_from("<II", data, place)
        if size > len(data) - place - 8:
            message = f"the chunk at byte {place} claims {size} bytes, {len(data) - place - 8}"
            raise errors.InputError(path, f"{message} are left: {AGAIN}")
        found.setdefault(kind, data[place + 8 : place + 8 + size])
        place += 8 + size
    return found


def refuse_compressed(path: Path, extensions: object) -> None:
    """Refuse an object of the document whose extensions compress its data."""
    for name, word in COMPRESSED.items():
        if isinstance(extensions, dict) and name in extensions:
            message = f"is compressed by {word} ({name}), which is not read here"
            raise errors.InputError(path, message + ": export it without compression")


def whole(path: Path, value: object, what: str) -> int:
    """Return a whole number from 0, which JSON may hold anything in place of."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise errors.InputError(path, f"{what} is {value!r:.40}, no whole number: {AGAIN}")
    return value


def item(path: Path, items: object, index: object, what: str) -> object:
    """Return an object of a list of the document by its number."""
    number = whole(path, index, f"the number of a {what}")
    if not isinstance(items, list) or number >= len(items) or items[number] is None:
        count = len(items) if isinstance(items, list) else 0
        message = f"names {what} {number}, the file has {count}"
        raise errors.InputError(path, f"{message}: {AGAIN}")
    return items[number]


def values(glb: Glb, index: object, kinds: Sequence[str], rows: int | None = None) -> np.ndarray:
    """Return what an accessor holds as (N, C) float64 array, normalised integers as fractions.

    Parameters
    ----------
    glb : the file
    index : number of the accessor
    kinds : types that it may have
    rows : how many elements it must have; only then may they be zeros that the file leaves out

    Raises
    ------
    errors.InputError
        if it is of another form, or reaches beyond what is in the file
    """
    accessor = _accessor(glb, index)
    stored = _stored(glb, index, kinds, rows)
    if accessor.normalized is not True or stored.dtype.kind == "f":
        return stored.astype(float)
    return np.maximum(stored.astype(float) / np.iinfo(stored.dtype).max, -1.0)


def whole_numbers(glb: Glb, index: object) -> np.ndarray:
    """Return the whole numbers (N,) of a scalar accessor, such as the indices of triangles."""
    stored = _stored(glb, index, [gltf.SCALAR], None)
    if stored.dtype.kind != "u":
        raise errors.InputError(glb.path, f"accessor {index} holds no indices: {AGAIN}")
    return stored[:, 0].astype(np.int64)


def _accessor(glb: Glb, index: object) -> gltf.Accessor:
    """Return an accessor by its number."""
    return item(glb.path, glb.document.accessors, index, "accessor")


def _stored(glb: Glb, index: object, kinds: Sequence[str], rows: int | None) -> np.ndarray:
    """Return the numbers (N, C) that an accessor stores, in the type in which it does."""
    accessor, what = _accessor(glb, index), f"accessor {index}"
    count = whole(glb.path, accessor.count, f"the count of {what}")
    dtype = _dtype(glb, accessor.componentType, what)
    if accessor.type not in kinds:
        message = f"{what} is of type {accessor.type!r:.20}, expected {' or '.join(kinds)}"
        raise errors.InputError(glb.path, f"{message}: {AGAIN}")
    if rows is not None and count != rows:
        message = f"{what} has {count} elements, expected {rows} as the neutral has"
        raise errors.InputError(glb.path, f"{message}: {AGAIN}")
    width = WIDTHS[accessor.type]
    if accessor.bufferView is not None:
        dense = _viewed(glb, accessor, (count, width), dtype, what)
    elif rows is not None:
        dense = np.zeros((count, width), dtype)
    else:
        message = f"{what} claims {count} elements and has no data: {AGAIN}"
        raise errors.InputError(glb.path, message)
    if accessor.sparse is None:
        return dense
    sparse, dense = accessor.sparse, dense.copy()
    stored = whole(glb.path, sparse.count, f"the sparse count of {what}")
    kind = _dtype(glb, getattr(sparse.indices, "componentType", None), what)
    places = _viewed(glb, sparse.indices, (stored, 1), kind, what)[:, 0]
    if kind.kind != "u" or (places >= count).any():
        raise errors.InputError(glb.path, f"{what} is sparse beyond its {count} elements: {AGAIN}")
    dense[places] = _viewed(glb, sparse.values, (stored, width), dtype, what)
    return dense


def _dtype(glb: Glb, component: object, what: str) -> np.dtype:
    """Return the type of a component."""
    if not isinstance(component, int) or component not in DTYPES:
        message = f"{what} holds components of type {component!r:.20}, which glTF does not know"
        raise errors.InputError(glb.path, f"{message}: {AGAIN}")
    return np.dtype(DTYPES[component])


def _viewed(
    glb: Glb, owner: object, shape: tuple[int, int], dtype: np.dtype, what: str
) -> np.ndarray:
    """Return an array that lies in the buffer, as its owner says: an accessor, or a part of one."""
    path, document = glb.path, glb.document
    number = getattr(owner, "bufferView", None)
    view = item(path, document.bufferViews, number, "buffer view")
    refuse_compressed(path, view.extensions)
    buffer = item(path, document.buffers, view.buffer, "buffer")
    if view.buffer != 0 or buffer.uri is not None:
        message = "keeps data outside its binary chunk: export it as one GLB file"
        raise errors.InputError(path, message)
    first = whole(path, view.byteOffset or 0, f"the offset of buffer view {number}")
    length = whole(path, view.byteLength, f"the length of buffer view {number}")
    inside = whole(path, owner.byteOffset or 0, f"the offset of {what}")
    size = shape[1] * dtype.itemsize
    stride = whole(path, view.byteStride or size, f"the stride of buffer view {number}")
    end = inside + stride * (shape[0] - 1) + size if shape[0] else 0
    if stride < size or end > length or first + length > len(glb.binary):
        message = f"{what} reaches beyond its data: {shape[0]} elements of {size} bytes from"
        message += f" {first + inside}, buffer view {number} ends at {first + length}"
        raise errors.InputError(path, f"{message}, the file's data at {len(glb.binary)}: {AGAIN}")
    if not shape[0]:
        return np.zeros(shape, dtype)
    return np.ndarray(shape, dtype, glb.binary, first + inside, (stride, dtype.itemsize))
