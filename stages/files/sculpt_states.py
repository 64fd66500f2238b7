"""`sculpts.parquet`: the state of each sculpt of a character, what was found and what to do.

A row is a sculpt: region, key_shape, path, state (`present`, `missing`, `suspicious`, `unused`),
detail (what was found) and cure (what to do).
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

import pyarrow as pa

from stages.files import parquet, provenance

KIND = "sculpts"
COLUMNS = ("region", "key_shape", "path", "state", "detail", "cure")

# region and key shape
Key = tuple[str, str]


class StateTable:
    """The table of states while faults are found; several of one sculpt stand together.

    Parameters
    ----------
    paths : where each sculpt is expected
    """

    def __init__(self, paths: dict[Key, Path]):
        self.rows = {key: _row(*key, path) for key, path in paths.items()}

    def set(self, key: Key, state: str, detail: str, cure: str) -> None:
        """Give a sculpt a state, with what was found and what to do."""
        row = self.rows[key]
        row["state"] = state
        row["detail"] = f"{row['detail']}; {detail}" if row["detail"] else detail
        row["cure"] = f"{row['cure']}; {cure}" if row["cure"] else cure

    def suspect(self, key: Key, detail: str, cure: str) -> None:
        """Call a sculpt suspicious."""
        self.set(key, "suspicious", detail, cure)

    def add_unused(self, listed: Iterable[str | Path]) -> None:
        """Add the files among those listed that are no key shape's sculpt."""
        expected = {row["path"] for row in self.rows.values()}
        cure = "remove it, or correct its folder, name or format to one of the brief"
        for path in sorted(set(map(Path, listed))):
            if path.as_posix() not in expected:
                key = path.parent.name, path.name
                self.rows[key] = _row(path.parent.name, path.stem, path)
                self.set(key, "unused", "no key shape expects this file", cure)


def _row(region: str, key_shape: str, path: Path) -> dict[str, str]:
    """Return the row of a sculpt that nothing is wrong with."""
    cells = (region, key_shape, path.as_posix(), "present", "", "")
    return dict(zip(COLUMNS, cells, strict=True))


def write(
    path: str | Path, rows: Sequence[dict[str, str]], sources: Iterable[str | Path] = ()
) -> None:
    """Write the states of sculpts, each row with the cells of `COLUMNS`."""
    table = pa.table({name: pa.array([row[name] for row in rows], pa.string()) for name in COLUMNS})
    parquet.write(path, table, provenance.stamp(KIND, sources))


def read(path: str | Path) -> list[dict[str, str]]:
    """Read the states of sculpts.

    Raises
    ------
    errors.InputError
        if the file is no table of them
    """
    return parquet.read(path, KIND)[0].to_pylist()
