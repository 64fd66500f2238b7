"""What every file between stages says of itself: kind, layout, writer and sources.

No date and no absolute path, so that the same inputs give the same bytes anywhere.
"""

import hashlib
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa

from stages.files import errors

LAYOUT_VERSION = 1
CHUNK_BYTES = 1 << 20


def sha256(path: str | Path) -> str:
    """Return the hexadecimal sha256 of a file's bytes."""
    digest = hashlib.sha256()
    with Path(path).open("rb") as stream:
        while chunk := stream.read(CHUNK_BYTES):
            digest.update(chunk)
    return digest.hexdigest()


def stamp(kind: str, sources: Iterable[str | Path] = ()) -> dict:
    """Return the metadata that is the same for every kind of file.

    Parameters
    ----------
    kind : name of the file's kind; its reader refuses another
    sources : files whose bytes decided this one's; named without their folders
    """
    return {
        "kind": kind,
        "layout_version": LAYOUT_VERSION,
        "written_with": {"numpy": np.__version__, "pyarrow": pa.__version__},
        "sources": [{"name": Path(p).name, "sha256": sha256(p)} for p in sources],
    }


def check(path: str | Path, meta: dict, kind: str | Sequence[str]) -> None:
    """Refuse a file of another kind, or of none of several, or of another version's layout.

    Raises
    ------
    errors.InputError
        naming the file, what was expected and what was found
    """
    found = meta.get("kind", "nothing")
    kinds = [kind] if isinstance(kind, str) else kind
    if found not in kinds:
        expected = " or ".join(f"'{name}'" for name in kinds)
        message = f"this is a file of kind '{found}', expected {expected}: correct the path"
        raise errors.InputError(path, message)
    version = meta.get("layout_version")
    if version != LAYOUT_VERSION:
        message = (
            f"layout version {version}, this keyface reads {LAYOUT_VERSION}: delete it, run again"
        )
        raise errors.InputError(path, message)
