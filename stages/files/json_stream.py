"""JSON files piece by piece: a frame at a time is held, not the objects of a whole take."""

import json
import re
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any

from stages.files import errors, text_file

BLANK = re.compile(r"[ \t\r\n]*")
HEAD_BYTES = 64
Decoded = tuple[Any, int]


def starts_as_json(path: str | Path) -> bool:
    """Say whether a text starts with a list or an object."""
    with Path(path).open("rb") as stream:
        head = stream.read(HEAD_BYTES).replace(b"\0", b"")
    return head.lstrip(b"\xef\xbb\xbf\xff\xfe \t\r\n").startswith((b"{", b"["))


def plain(key: str) -> str:
    """Return a key without case and underscores."""
    return key.replace("_", "").lower()


def items(path: str | Path, lists: Collection[str]) -> Iterator[tuple[str, Any]]:
    """Yield key and value of every member, and each element of the lists that are named.

    A list as a whole, and a file with one value on each line, yield their elements under an empty
    key; so does a named list within an object.

    Parameters
    ----------
    path : the file
    lists : keys whose lists are yielded by their elements

    Raises
    ------
    errors.InputError
        naming line and column where the file is cut short or no JSON
    """
    text = text_file.read(path)
    try:
        if _has_lines(text):
            yield from (("", json.loads(line)) for line in text.splitlines() if line.strip())
        else:
            yield from _whole(text, lists)
    except json.JSONDecodeError as error:
        message = f"line {error.lineno}, column {error.colno}: {error.msg.lower()}"
        raise errors.InputError(path, f"{message}: is it cut short? export it again") from error
    except (ValueError, RecursionError) as error:
        raise errors.InputError(path, f"is no sensible JSON ({error}): export it again") from error


def _skip(text: str, at: int) -> int:
    """Return the place after blanks."""
    return BLANK.match(text, at).end()


def _has_lines(text: str) -> bool:
    """Say whether each line is a value of its own."""
    first, _, rest = text.strip().partition("\n")
    if not rest.lstrip().startswith(first[:1]):
        return False
    try:
        json.loads(first)
    except (ValueError, RecursionError):
        return False
    return True


def _whole(text: str, lists: Collection[str]) -> Iterator[tuple[str, Any]]:
    """Yield what stands in the one list or object of a text."""
    end = yield from _members(text, json.JSONDecoder().raw_decode, _skip(text, 0), lists)
    if _skip(text, end) != len(text):
        raise json.JSONDecodeError("something stands after the end", text, end)


def _members(
    text: str, decode: Callable[[str, int], Decoded], at: int, lists: Collection[str]
) -> Iterator[tuple[str, Any]]:
    """Yield what stands in the list or object at a place; return the place after it."""
    opening = text[at : at + 1]
    if opening not in ("[", "{"):
        raise json.JSONDecodeError("expected a list or an object", text, at)
    closing = "]" if opening == "[" else "}"
    at = _skip(text, at + 1)
    while text[at : at + 1] != closing:
        key = ""
        if opening == "{":
            key, at = _key(text, decode, at)
        if key in lists and text[at : at + 1] == "[":
            at = yield from _members(text, decode, at, lists)
        else:
            value, at = decode(text, at)
            yield key, value
        at = _skip(text, at)
        if text[at : at + 1] == ",":
            at = _skip(text, at + 1)
        elif text[at : at + 1] != closing:
            raise json.JSONDecodeError("expected a comma", text, at)
    return at + 1


def _key(text: str, decode: Callable[[str, int], Decoded], at: int) -> tuple[str, int]:
    """Return a key and the place of its value."""
    key, at = decode(text, at)
    at = _skip(text, at)
    if not isinstance(key, str) or text[at : at + 1] != ":":
        raise json.JSONDecodeError("expected a key and a colon", text, at)
    return key, _skip(text, at + 1)
