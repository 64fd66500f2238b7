"""Parquet tables of ours: Arrow columns, and a JSON header in the file's metadata."""

import json
from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from stages.files import atomic, errors, provenance

ROW_GROUP = 4096  # rows, so that long takes can be read in parts
META_KEY = b"keyface"


def write(path: str | Path, table: pa.Table, header: dict) -> None:
    """Write a table and its header, which holds what `provenance.stamp` gives."""
    meta = {META_KEY: json.dumps(header, sort_keys=True).encode()}
    with atomic.replacing(path) as temporary:
        pq.write_table(
            table.replace_schema_metadata(meta),
            temporary,
            row_group_size=ROW_GROUP,
            compression="zstd",
        )


def read(path: str | Path, kind: str | Sequence[str]) -> tuple[pa.Table, dict]:
    """Read the table and the header of a file of one kind, or of one of several.

    Raises
    ------
    errors.InputError
        if the file is no Parquet file of ours or is of another kind
    """
    try:
        table = pq.read_table(path)
        header = json.loads((table.schema.metadata or {}).get(META_KEY, b"{}"))
    except FileNotFoundError:
        raise
    except (pa.ArrowException, OSError, ValueError) as error:
        message = f"no Parquet file ({str(error).splitlines()[0]}): delete it and run again"
        raise errors.InputError(path, message) from error
    provenance.check(path, header, kind)
    return table, header
