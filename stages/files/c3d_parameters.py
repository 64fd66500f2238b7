"""The parameter section of a C3D file: named values in groups, such as POINT:RATE.

A group or parameter is: length of its name (int8, negative if locked), number of its group (int8,
negative for the group itself), the name, and the distance to the next one (int16, counted from
itself). A parameter goes on with its type (-1 text, 1 byte, 2 int16, 4 float32), its dimensions,
its values in Fortran's order and a description.
"""

import math
from pathlib import Path

import numpy as np

from stages.files import errors

TYPES = {-1: "S1", 1: "u1", 2: "<u2", 4: "<f4"}
NEXT_BYTES = 2


def read(path: str | Path, section: bytes) -> dict[str, list]:
    """Return `GROUP:PARAMETER` -> values: text stripped, whole numbers unsigned.

    Parameters
    ----------
    path : the file, for the error
    section : the section's bytes without its four bytes of header

    Raises
    ------
    errors.InputError
        if the section ends within a parameter
    """
    groups: dict[int, str] = {}
    found: list[tuple[int, str, list]] = []
    place = 0
    try:
        while place + 1 < len(section) and section[place]:
            length = abs(_signed(section[place]))
            number = _signed(section[place + 1])
            name = section[place + 2 : place + 2 + length].decode("latin-1").strip().upper()
            after = place + 2 + length
            step = int.from_bytes(section[after : after + NEXT_BYTES], "little")
            if number < 0:
                groups[-number] = name
            else:
                found.append((number, name, _values(section, after + NEXT_BYTES)))
            if not step:
                break
            place = after + step
    except (IndexError, KeyError, ValueError) as error:
        message = f"its parameter section is damaged at byte {place}: export it again"
        raise errors.InputError(path, message) from error
    return {f"{groups.get(number, '')}:{name}": values for number, name, values in found}


def _signed(byte: int) -> int:
    """Return a byte as a number from -128 to 127."""
    return byte - 256 if byte > 127 else byte


def _values(section: bytes, start: int) -> list:
    """Return the values of the parameter whose type stands at `start`.

    Raises
    ------
    IndexError, KeyError or ValueError
        if the section ends before them, or the type is none of the format's
    """
    kind = _signed(section[start])
    shape = [section[start + 2 + d] for d in range(section[start + 1])]
    count = math.prod(shape)
    if count == 0:
        return []
    if count > len(section):
        raise ValueError(f"{count} values in a section of {len(section)} bytes")
    values = np.frombuffer(section, TYPES[kind], count, start + 2 + len(shape))
    if kind != -1:
        return values.tolist()
    width = shape[0] if shape else 1
    text = values.tobytes().decode("latin-1")
    return [text[at : at + width].strip(" \0") for at in range(0, count, width)]
