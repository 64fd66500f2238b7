"""A character's poses on disk, whether meshes or tables of controls, and the table of their states.

A sculpt is `<sculpts folder>/<region>/<key shape><suffix of the neutral>`. Its state is a row of
`sculpts.parquet`: region, key_shape, path, state (`present`, `missing`, `suspicious`, `unused`),
detail (what was found) and cure (what to do).
"""

import dataclasses
import json
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from stages.files import atomic, controls, errors, key_shapes, mesh, provenance, series

KIND = "sculpts"
COLUMNS = ("region", "key_shape", "path", "state", "detail", "cure")
CONTROL_SUFFIX = ".csv"

# region and key shape
Key = tuple[str, str]


@dataclasses.dataclass(frozen=True)
class Pose:
    """The neutral, which every sculpt is read against.

    Attributes
    ----------
    names : V names, a vertex's number or a control's name
    coordinates : (V, D) float64 array, D = 3 for a mesh and 1 for controls
    sizes, corners, colours : polygons and vertex colours as in `mesh.Mesh`
    is_controls : whether it is a table of controls
    """

    names: list[str]
    coordinates: np.ndarray
    sizes: np.ndarray
    corners: np.ndarray
    colours: np.ndarray
    is_controls: bool


def path_of(folder: str | Path, region: str, key_shape: str, neutral: str | Path) -> Path:
    """Return where the sculpt of a key shape is expected."""
    return Path(folder) / region / (key_shape + Path(neutral).suffix)


def actor_offsets(path: str | Path) -> dict[str, dict[str, np.ndarray]]:
    """Return how the actor's key shapes differ from the actor's neutral.

    Parameters
    ----------
    path : `key_shapes.parquet`

    Returns
    -------
    region -> key shape -> (2Q,) float array [face units]
    """
    shapes = key_shapes.read(path)
    neutral = json.loads(pq.read_schema(path).metadata[key_shapes.META_KEY])["neutral"]
    offsets: dict[str, dict[str, np.ndarray]] = {}
    for shape in shapes:
        offset = np.array(shape.shape) - np.array(neutral[shape.region])
        offsets.setdefault(shape.region, {})[shape.key_shape] = offset
    return offsets


def read_neutral(path: str | Path) -> Pose:
    """Read a neutral, a mesh or a table of controls by its suffix."""
    if Path(path).suffix == CONTROL_SUFFIX:
        pose = controls.read(path)
        none = np.zeros(0, np.int32)
        values = np.array(list(pose.values())).reshape(-1, 1)
        return Pose(list(pose), values, none, none, np.zeros((0, 3)), is_controls=True)
    read = mesh.read(path)
    names = [str(vertex) for vertex in range(len(read.vertices))]
    return Pose(names, read.vertices, read.sizes, read.corners, read.colours, is_controls=False)


def read_sculpt(path: str | Path, neutral: Pose) -> tuple[np.ndarray, bool]:
    """Read a sculpt of a neutral.

    Returns
    -------
    coordinates : (V, D) float64 array
    same_polygons : whether its polygons are the neutral's, in the same order

    Raises
    ------
    errors.InputError
        if it cannot be read, or has other vertices or controls than the neutral
    """
    if neutral.is_controls:
        values = controls.in_order(path, controls.read(path), neutral.names)
        return np.array(values).reshape(-1, 1), True
    read = mesh.read(path)
    if len(read.vertices) != len(neutral.coordinates):
        found, wanted = len(read.vertices), len(neutral.coordinates)
        message = f"has {found} vertices, the neutral has {wanted}: sculpt on a copy of the neutral"
        raise errors.InputError(path, message + ", and export without merging or splitting")
    same = np.array_equal(read.sizes, neutral.sizes) and np.array_equal(
        read.corners, neutral.corners
    )
    return read.vertices, same


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

    def add_unused(self, listed: Iterable[str | Path]) -> None:
        """Add the files among those listed that are no key shape's sculpt."""
        expected = {row["path"] for row in self.rows.values()}
        for path in sorted(set(map(Path, listed))):
            if path.as_posix() not in expected:
                key = path.parent.name, path.name
                self.rows[key] = _row(path.parent.name, path.stem, path)
                self.set(
                    key, "unused", "no key shape expects this file",
                    "remove it, or correct its folder, name or format to one of the brief",
                )  # fmt: skip


def _row(region: str, key_shape: str, path: Path) -> dict[str, str]:
    """Return the row of a sculpt that nothing is wrong with."""
    cells = (region, key_shape, path.as_posix(), "present", "", "")
    return dict(zip(COLUMNS, cells, strict=True))


def write_states(
    path: str | Path, rows: Sequence[dict[str, str]], sources: Iterable[str | Path] = ()
) -> None:
    """Write the states of sculpts, each row with the cells of `COLUMNS`."""
    table = pa.table({name: pa.array([row[name] for row in rows], pa.string()) for name in COLUMNS})
    header = json.dumps(provenance.stamp(KIND, sources), sort_keys=True).encode()
    with atomic.replacing(path) as temporary:
        pq.write_table(table.replace_schema_metadata({series.META_KEY: header}), temporary)


def read_states(path: str | Path) -> list[dict[str, str]]:
    """Read the states of sculpts.

    Raises
    ------
    errors.InputError
        if the file is no table of them
    """
    try:
        table = pq.read_table(path)
    except pa.ArrowInvalid as error:
        raise errors.InputError(path, f"no Parquet file: {error}") from error
    header = json.loads((table.schema.metadata or {}).get(series.META_KEY, b"{}"))
    provenance.check(path, header, KIND)
    return table.to_pylist()
