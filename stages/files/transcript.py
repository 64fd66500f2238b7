"""Transcripts: plain text of what is spoken, in words of a dictionary."""

import re
from pathlib import Path

from stages.files import errors, text_file

REMARK = re.compile(r"\[[^\]]*\]|\([^)]*\)|<[^>]*>")
# a word holds letters, digits and apostrophes; what lies between words parts them, hyphens too
WORD = re.compile(r"[^\W_]+(?:'[^\W_]+)*")


def read(path: str | Path) -> list[str]:
    """Read the words in lower case, without punctuation and without remarks in brackets.

    Raises
    ------
    errors.InputError
        if the file is no text, or holds no word
    """
    text = text_file.read(path).replace("\N{RIGHT SINGLE QUOTATION MARK}", "'").lower()
    words = WORD.findall(REMARK.sub(" ", text))
    if not words:
        raise errors.InputError(path, "holds no word: write what is spoken")
    return words
