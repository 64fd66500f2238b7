"""`poses.parquet`: the extremes that a character has, and where each came from.

A row per extreme; those that equal the neutral are listed too, with no vertex moved.
"""

import dataclasses
from collections.abc import Iterable
from pathlib import Path

import pyarrow as pa

from stages.files import parquet, provenance

KIND = "poses"
NEUTRAL = "neutral"
SCHEMA = pa.schema(
    {"layer": pa.string(), "name": pa.string(), "source": pa.string(), "moved": pa.int32()}
)


@dataclasses.dataclass(frozen=True)
class Pose:
    """An extreme that a character has.

    Attributes
    ----------
    layer, name : the rig calls it `<mask>.<layer>_<name>`
    source : name of its file; `neutral` where the neutral stands for it
    moved : vertices or controls that differ from the neutral
    """

    layer: str
    name: str
    source: str
    moved: int


def write(path: str | Path, rows: Iterable[Pose], sources: Iterable[str | Path] = ()) -> None:
    """Write the extremes of a character."""
    table = pa.Table.from_pylist([dataclasses.asdict(row) for row in rows], SCHEMA)
    parquet.write(path, table, provenance.stamp(KIND, sources))


def read(path: str | Path) -> list[Pose]:
    """Read the extremes of a character.

    Raises
    ------
    errors.InputError
        if the file is of another kind
    """
    table, _ = parquet.read(path, KIND)
    return [Pose(**row) for row in table.select(SCHEMA.names).to_pylist()]
