"""`pair_residuals.parquet`: how far each tuned pair lies from what the others say, worst first.

A row is a pair: animator, shot, frame, residual (root mean square over the shapes of tuned weight
minus the one predicted from the other pairs), doubt (the same measured by the spread that a pair
there may be expected to have), the partner that it contradicts most (partner_animator,
partner_shot, partner_frame), and rank by doubt, from 1.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

import pyarrow as pa

from stages.files import parquet, provenance

KIND = "pair_residuals"
SCHEMA = pa.schema(
    {
        "animator": pa.string(),
        "shot": pa.string(),
        "frame": pa.int32(),
        "residual": pa.float64(),
        "doubt": pa.float64(),
        "partner_animator": pa.string(),
        "partner_shot": pa.string(),
        "partner_frame": pa.int32(),
        "rank": pa.int32(),
    }
)


def write(path: str | Path, rows: Sequence[dict], sources: Iterable[str | Path] = ()) -> None:
    """Write a row a pair, with the cells of the schema."""
    table = pa.Table.from_pylist(list(rows), SCHEMA)
    parquet.write(path, table, provenance.stamp(KIND, sources))


def read(path: str | Path) -> list[dict]:
    """Read the rows.

    Raises
    ------
    errors.InputError
        if the file is of another kind
    """
    return parquet.read(path, KIND)[0].to_pylist()
