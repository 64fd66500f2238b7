"""`references.parquet`: the frames that an animator tunes, and how far they reach.

A row is a frame: shot, frame, time_s, source (`viseme`, `extreme` or `coverage`), viseme, emotion,
leverage (how far it lies from the pairs tuned so far; NaN where there are none) and tuned_by (the
animators that have tuned it, with commas). The header holds `pairs`, how many pairs there are,
and `uncovered`, the share of all frames that lie outside of them, null without pairs.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

import pyarrow as pa

from stages.files import parquet, provenance

KIND = "references"
COLUMNS = {
    "shot": pa.string(),
    "frame": pa.int32(),
    "time_s": pa.float64(),
    "source": pa.string(),
    "viseme": pa.string(),
    "emotion": pa.string(),
    "leverage": pa.float64(),
    "tuned_by": pa.string(),
}


def write(
    path: str | Path, rows: Sequence[dict], header: dict, sources: Iterable[str | Path] = ()
) -> None:
    """Write reference frames, each row with the cells of `COLUMNS`."""
    table = pa.table(
        {name: pa.array([row[name] for row in rows], kind) for name, kind in COLUMNS.items()}
    )
    parquet.write(path, table, provenance.stamp(KIND, sources) | header)


def read(path: str | Path) -> tuple[list[dict], dict]:
    """Read reference frames and their header.

    Raises
    ------
    errors.InputError
        if the file is no table of them
    """
    table, header = parquet.read(path, KIND)
    return table.to_pylist(), header
