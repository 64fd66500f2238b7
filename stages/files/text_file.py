"""Text files of other programs: UTF-8, or UTF-16 with its byte order mark."""

import codecs
from pathlib import Path

from stages.files import errors


def read(path: str | Path) -> str:
    """Read a text, without its byte order mark.

    Raises
    ------
    errors.InputError
        if the file does not exist, is empty, or is in another encoding
    """
    try:
        data = Path(path).read_bytes()
    except FileNotFoundError:
        raise errors.InputError(path, "no such file: check its column of shots.tsv") from None
    wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        text = data.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as error:
        encoding = "UTF-16" if wide else "UTF-8"
        message = f"is no {encoding} text at byte {error.start}: save it as UTF-8"
        raise errors.InputError(path, message) from error
    if "\0" in text:
        raise errors.InputError(path, "is no text, or UTF-16 without its mark: save it as UTF-8")
    if not text.strip():
        raise errors.InputError(path, "is empty: fill it, or leave its cell of shots.tsv blank")
    return text.replace("\r\n", "\n")
