"""`key_shapes.parquet` and `key_shape_errors.parquet`: what was chosen, why, and how well it does.

`key_shapes.parquet` has a row per region and key shape, in the order in which they were chosen;
`shape` holds the coordinates [face units] of the region's points, x and y in turn, in the order
that the file's metadata names under `points`. A name is never parsed: shot and frame are columns.
"""

import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa

from stages.files import parquet, provenance

KIND = "key_shapes"
ERRORS_KIND = "key_shape_errors"
SCHEMA = pa.schema(
    {
        "region": pa.string(),
        "key_shape": pa.string(),
        "shot": pa.string(),
        "frame": pa.int32(),
        "order": pa.int32(),
        "method": pa.string(),
        "locked": pa.bool_(),
        "confidence": pa.float32(),
        "reason": pa.string(),
        "count_reason": pa.string(),
        "shape": pa.list_(pa.float64()),
    }
)
ERRORS_SCHEMA = pa.schema(
    {
        "region": pa.string(),
        "method": pa.string(),
        "count": pa.int32(),
        "split": pa.string(),
        "rms": pa.float64(),
    }
)


@dataclasses.dataclass(frozen=True)
class KeyShape:
    """A frame that an artist sculpts for one region.

    Attributes
    ----------
    region, key_shape : its name is `key_shape`, unique within the region
    shot, frame : where it stands
    order : place in the order of choice, from 0
    method : how it was chosen
    locked : whether the artist settled it
    confidence : of the tracking, 0..1
    reason : why it was chosen, in plain words
    count_reason : why the region has as many
    shape : coordinates [face units] of the region's points, x and y in turn
    """

    region: str
    key_shape: str
    shot: str
    frame: int
    order: int
    method: str
    locked: bool
    confidence: float
    reason: str
    count_reason: str
    shape: list[float]


def name_of(shot: str, frame: int) -> str:
    """Return the name of the key shape at a frame of a shot."""
    return f"{shot}_f{frame:04d}"


def write(
    path: str | Path,
    rows: Iterable[dict],
    points: dict[str, Sequence[str]],
    neutral: dict[str, Sequence[float]],
    sources: Iterable[str | Path] = (),
) -> None:
    """Write rows with the fields of `KeyShape`; names and neutral of every region's points."""
    meta = provenance.stamp(KIND, sources) | {
        "units": "face units",
        "points": {region: list(names) for region, names in points.items()},
        "neutral": {region: list(values) for region, values in neutral.items()},
    }
    _write(path, list(rows), SCHEMA, meta)


def read(path: str | Path) -> list[KeyShape]:
    """Read all key shapes of an actor.

    Raises
    ------
    errors.InputError
        if the file is of another kind
    """
    rows, _ = _read(path, KIND, SCHEMA)
    return [KeyShape(**row) for row in rows]


def read_points(path: str | Path) -> dict[str, list[str]]:
    """Read the names of the points of every region, in the order of `KeyShape.shape`."""
    return _read(path, KIND, SCHEMA)[1]["points"]


def read_offsets(path: str | Path) -> dict[str, dict[str, np.ndarray]]:
    """Read how the key shapes differ from the actor's neutral.

    Returns
    -------
    region -> key shape -> (2Q,) float array [face units]
    """
    rows, header = _read(path, KIND, SCHEMA)
    offsets: dict[str, dict[str, np.ndarray]] = {}
    for row in rows:
        offset = np.array(row["shape"]) - np.array(header["neutral"][row["region"]])
        offsets.setdefault(row["region"], {})[row["key_shape"]] = offset
    return offsets


def write_errors(path: str | Path, rows: Iterable[dict], sources: Iterable[str | Path]) -> None:
    """Write rows of region, method, count, split (`training`, `held_out`) and rms [face units]."""
    meta = provenance.stamp(ERRORS_KIND, sources) | {"units": "face units"}
    _write(path, list(rows), ERRORS_SCHEMA, meta)


def read_errors(path: str | Path) -> list[dict]:
    """Read the rows of the errors of every method, count and split."""
    return _read(path, ERRORS_KIND, ERRORS_SCHEMA)[0]


def _write(path: str | Path, rows: list[dict], schema: pa.Schema, header: dict) -> None:
    """Write rows as a Parquet table."""
    parquet.write(path, pa.Table.from_pylist(rows, schema), header)


def _read(path: str | Path, kind: str, schema: pa.Schema) -> tuple[list[dict], dict]:
    """Read the rows and the header of a Parquet table of one kind."""
    table, header = parquet.read(path, kind)
    return table.select(schema.names).to_pylist(), header
