"""Decode scan-line EXR files from their bytes: a second reader beside the OpenEXR library.

After the file layout document of OpenEXR: header of attributes, table of offsets, blocks of 1 or 16
lines, deflated after every byte but the first was replaced by its difference from the one before
(plus 128) and the bytes were split into two halves.
"""

import struct
import zlib
from pathlib import Path

import numpy as np

MAGIC = 20000630
LINES = {0: 1, 2: 1, 3: 16}  # compression: none, ZIPS, ZIP
DTYPES = {1: "<f2", 2: "<f4"}


def _attributes(data: bytes) -> tuple[dict[str, bytes], int]:
    """Return the header's attributes by name, and where it ends."""
    found, place = {}, 8
    while data[place]:
        name, place = _text(data, place)
        _, place = _text(data, place)
        size = struct.unpack_from("<i", data, place)[0]
        found[name] = data[place + 4 : place + 4 + size]
        place += 4 + size
    return found, place + 1


def _text(data: bytes, place: int) -> tuple[str, int]:
    """Return a text that ends with a zero byte, and the place behind it."""
    end = data.index(b"\0", place)
    return data[place:end].decode(), end + 1


def _channels(data: bytes) -> dict[str, str]:
    """Return the type of each channel, in the file's order."""
    found, place = {}, 0
    while data[place]:
        name, place = _text(data, place)
        found[name] = DTYPES[struct.unpack_from("<i", data, place)[0]]
        place += 16
    return found


def _unpacked(packed: bytes) -> bytes:
    """Undo deflation, differences and halves."""
    steps = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    steps[1:] -= 128
    values = np.cumsum(steps).astype(np.uint8)
    half = -(-len(values) // 2)
    mixed = np.empty(len(values), np.uint8)
    mixed[0::2], mixed[1::2] = values[:half], values[half:]
    return mixed.tobytes()


def read(path: Path) -> np.ndarray:
    """Return the (rows, columns, 3) float64 pixels of R, G and B."""
    data = path.read_bytes()
    magic, version = struct.unpack_from("<ii", data)
    if magic != MAGIC or version & ~0xFF:
        raise ValueError(f"{path}: no EXR file of scan lines")
    header, place = _attributes(data)
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    lines = LINES[header["compression"][0]]
    channels = _channels(header["channels"])
    pixels = {name: np.empty((height, width)) for name in channels}
    count = -(-height // lines)
    for offset in struct.unpack_from(f"<{count}Q", data, place):
        line, size = struct.unpack_from("<ii", data, offset)
        block = data[offset + 8 : offset + 8 + size]
        rows = min(lines, bottom + 1 - line)
        whole = rows * width * sum(np.dtype(kind).itemsize for kind in channels.values())
        block = block if size == whole else _unpacked(block)
        at = 0
        for row in range(line - top, line - top + rows):
            for name, kind in channels.items():
                pixels[name][row] = np.frombuffer(block, kind, width, at)
                at += width * np.dtype(kind).itemsize
    return np.stack([pixels[name] for name in "RGB"], axis=-1)
