"""`phones.parquet`: what is spoken when, on the clock of the film.

A row is a phone: start_s, end_s (t = 0 at the film's first picture), phone (ARPAbet in lower case,
without stress; `pau` is silence, `spn` a word that the aligner did not know; blank where only the
mouth is known), viseme (blank where the mouth is not known), word (blank in silence) and score
(how well the sound fits the phone, natural logarithm of a likelihood ratio per frame of 10 ms, at
most 0; NaN where the phone was not found in the sound but given).
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import pyarrow as pa

from stages.files import parquet, provenance

KIND = "phones"
TYPES = (pa.float64(), pa.float64(), pa.string(), pa.string(), pa.string(), pa.float32())


class Phone(NamedTuple):
    """A row of the table."""

    start_s: float
    end_s: float
    phone: str
    viseme: str
    word: str = ""
    score: float = float("nan")


def write(
    path: str | Path, rows: Sequence[Phone], meta: dict, sources: Iterable[str | Path]
) -> None:
    """Write phones in the order of time.

    Parameters
    ----------
    path : file to write
    rows : the phones
    meta : what else the file says of itself: the scheme of visemes, where the phones are from
    sources : files whose bytes decided this one's
    """
    columns = {
        name: pa.array([row[index] for row in rows], kind)
        for index, (name, kind) in enumerate(zip(Phone._fields, TYPES, strict=True))
    }
    header = provenance.stamp(KIND, sources) | {"units": "s"} | meta
    parquet.write(path, pa.table(columns), header)


def read(path: str | Path) -> list[Phone]:
    """Read phones.

    Raises
    ------
    errors.InputError
        if the file is no table of them
    """
    table, _ = parquet.read(path, KIND)
    return [Phone(**row) for row in table.to_pylist()]
