"""Stanford PLY, as text or binary: the elements `vertex` and `face`."""

import dataclasses
import io
from pathlib import Path

import numpy as np

from stages.files import errors

MOST_VERTICES = 2**31
TYPES = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}
FORMATS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclasses.dataclass
class Element:
    """An element of the header: its name, count and properties (name, type, type of the length)."""

    name: str
    count: int
    properties: list[tuple[str, str, str | None]]


def read(path: Path) -> tuple[np.ndarray, list, list, np.ndarray]:
    """Read a PLY file; what is returned and raised is that of `obj.read`."""
    with path.open("rb") as stream:
        order, elements = _header(path, stream)
        body = stream.read()
    source = io.StringIO(body.decode("ascii", "replace")) if order is None else io.BytesIO(body)
    vertices, colours, sizes, corners = np.zeros((0, 3)), np.zeros((0, 3)), [], []
    for element in elements:
        # a row takes a byte at least: a count beyond that would only fill the memory
        if not 0 <= element.count <= len(body):
            message = f"element {element.name} is cut short: it promises {element.count} rows"
            raise errors.InputError(path, f"{message} in {len(body)} bytes: export again")
        try:
            rows = _rows(source, element, order)
            if element.name == "vertex":
                vertices, colours = _vertices(path, element, rows)
            elif element.name == "face":
                sizes, corners = _polygons(path, element, rows)
        except errors.InputError:
            raise
        except (ValueError, IndexError, TypeError, OverflowError) as error:
            message = f"element {element.name} is cut short or damaged ({error}): export again"
            raise errors.InputError(path, message) from None
    return vertices, sizes, corners, colours


def _header(path: Path, stream: io.BufferedReader) -> tuple[str | None, list[Element]]:
    """Read the header; return the byte order (None for text) and the elements."""
    order, elements, ended = "", [], False
    for number, raw in enumerate(stream, start=1):
        words = raw.decode("ascii", "replace").split()
        try:
            if number == 1 and words != ["ply"]:
                break
            if words[:1] == ["format"]:
                order = FORMATS[words[1]]
            elif words[:1] == ["element"]:
                elements.append(Element(words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                elements[-1].properties.append((words[4], TYPES[words[3]], TYPES[words[2]]))
            elif words[:1] == ["property"]:
                elements[-1].properties.append((words[2], TYPES[words[1]], None))
        except (KeyError, IndexError, ValueError):
            message = f"line {number}: '{' '.join(words)}' is no PLY header: export again"
            raise errors.InputError(path, message) from None
        if words == ["end_header"]:
            ended = True
            break
    if not ended or order == "":
        raise errors.InputError(path, "has no PLY header: export the mesh again")
    return order, elements


def _rows(source: io.IOBase, element: Element, order: str | None) -> list | np.ndarray:
    """Read the rows of an element: a table where all properties are numbers, else lists."""
    if order is None:
        return [_text_row(source.readline().split(), element) for _ in range(element.count)]
    if all(length is None for _, _, length in element.properties):
        dtype = np.dtype([(name, order + kind) for name, kind, _ in element.properties])
        data = source.read(dtype.itemsize * element.count)
        return [tuple(row) for row in np.frombuffer(data, dtype, element.count).tolist()]
    return [_binary_row(source, element, order) for _ in range(element.count)]


def _text_row(words: list[str], element: Element) -> list:
    """Read one row of text."""
    row, place = [], 0
    for _, kind, length in element.properties:
        count = 1 if length is None else int(words[place])
        place += length is not None
        values = [np.dtype(kind).type(word) for word in words[place : place + count]]
        if len(values) < count:
            raise ValueError("too few numbers in a row")
        row.append(values[0] if length is None else values)
        place += count
    return row


def _binary_row(source: io.BytesIO, element: Element, order: str) -> list:
    """Read one binary row that has lists."""
    row = []
    for _, kind, length in element.properties:
        count = 1 if length is None else int(_take(source, order + length, 1)[0])
        values = _take(source, order + kind, count)
        row.append(values[0] if length is None else values)
    return row


def _take(source: io.BytesIO, kind: str, count: int) -> np.ndarray:
    """Read `count` numbers of one type."""
    if count < 0:
        raise ValueError(f"a list of {count} numbers")
    return np.frombuffer(source.read(np.dtype(kind).itemsize * count), kind, count)


def _column(path: Path, element: Element, name: str) -> int:
    """Return where the property stands whose name starts with `name`."""
    names = [property_name for property_name, _, _ in element.properties]
    for index, found in enumerate(names):
        if found.startswith(name):
            return index
    raise errors.InputError(path, f"element {element.name} has no property {name}: export again")


def _polygons(path: Path, element: Element, rows: list) -> tuple[list, list]:
    """Return the number of corners of each polygon, and the corners of all."""
    column = _column(path, element, "vertex_ind")
    polygons = [row[column] for row in rows]
    corners = [int(index) for polygon in polygons for index in polygon]
    if corners and max(corners) >= MOST_VERTICES:
        raise ValueError(f"it names vertex {max(corners)}")
    return [len(polygon) for polygon in polygons], corners


def _vertices(path: Path, element: Element, rows: list) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and colours (whole numbers run from 0 to 255)."""
    table = np.array(rows, float).reshape(len(rows), len(element.properties))
    kinds = {name: kind for name, kind, _ in element.properties}
    positions = table[:, [_column(path, element, axis) for axis in "xyz"]]
    if not {"red", "green", "blue"} <= set(kinds):
        return positions, np.zeros((0, 3))
    colours = table[:, [_column(path, element, name) for name in ("red", "green", "blue")]]
    return positions, colours / 255 if kinds["red"] == "u1" else colours
