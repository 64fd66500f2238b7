"""Time series in Parquet: one row a frame, one float32 column a value.

Columns are `frame` (int32), `time_s` (float64), then `<point>.x`, `<region>.residual`, and so on.
NaN means not observed. The file's metadata holds kind, rational frame rate, units and sources.
"""

import dataclasses
from collections.abc import Iterable, Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np
import pyarrow as pa

from stages.files import errors, parquet, provenance


@dataclasses.dataclass(frozen=True)
class Series:
    """A time series as read.

    Attributes
    ----------
    frame : (T,) int32 array
    time_s : (T,) float64 array [s]
    columns : name -> (T,) float64 array, or of the type that was asked for
    rate : frames per second; the nominal rate where times vary
    meta : everything else that the file says of itself
    """

    frame: np.ndarray
    time_s: np.ndarray
    columns: dict[str, np.ndarray]
    rate: Fraction
    meta: dict


def write(
    path: str | Path,
    kind: str,
    frame: np.ndarray,
    time_s: np.ndarray,
    columns: dict[str, np.ndarray],
    rate: Fraction,
    meta: dict | None = None,
    sources: Iterable[str | Path] = (),
) -> None:
    """Write a time series.

    Parameters
    ----------
    path : the file
    kind : what the file is, for example `tracked`
    frame : (T,) int array
    time_s : (T,) float array [s]
    columns : name -> (T,) float array
    rate : frames per second, rational
    meta : units and names that the kind needs; JSON
    sources : files that it was made from
    """
    header = provenance.stamp(kind, sources) | {"rate": str(Fraction(rate))} | (meta or {})
    arrays = {
        "frame": np.asarray(frame, np.int32),
        "time_s": np.asarray(time_s, np.float64),
    } | {name: np.asarray(values, np.float32) for name, values in columns.items()}
    parquet.write(path, pa.table(arrays), header)


def read(path: str | Path, kind: str | Sequence[str], dtype: type = np.float64) -> Series:
    """Read a time series of one kind, or of one of several; `meta["kind"]` says which.

    Parameters
    ----------
    path : the file
    kind : what it may be
    dtype : of the columns; float32, as in the file, halves the memory of long takes of markers

    Raises
    ------
    errors.InputError
        if the file is no Parquet file of ours or is of another kind
    """
    table, meta = parquet.read(path, kind)
    columns = {
        name: table[name].to_numpy().astype(dtype, copy=False)
        for name in table.column_names
        if name not in ("frame", "time_s")
    }
    return Series(
        table["frame"].to_numpy(),
        table["time_s"].to_numpy(),
        columns,
        Fraction(meta["rate"]),
        meta,
    )


def stack(series: Series, path: str | Path, names: Sequence[str], axes: str = "xy") -> np.ndarray:
    """Return the columns `<name>.<axis>` as one array.

    Parameters
    ----------
    series : a time series
    path : its file, for the error
    names : the P points
    axes : the letters of the coordinates

    Returns
    -------
    (T, P, len(axes)) float array

    Raises
    ------
    errors.InputError
        naming the first column that is missing
    """
    wanted = [f"{name}.{axis}" for name in names for axis in axes]
    for column in wanted:
        if column not in series.columns:
            raise errors.InputError(path, f"column {column} is missing: delete it and run again")
    values = np.stack([series.columns[column] for column in wanted], axis=1)
    return values.reshape(len(series.frame), len(names), len(axes))


def unstack(values: np.ndarray, names: Sequence[str], axes: str = "xy") -> dict[str, np.ndarray]:
    """Return `<name>.<axis>` columns of a (T, P, len(axes)) array: the inverse of `stack`."""
    return {
        f"{name}.{axis}": values[:, p, a]
        for p, name in enumerate(names)
        for a, axis in enumerate(axes)
    }


def point_names(series: Series, axes: str = "xy") -> list[str]:
    """Return the names of the points with exactly these axes, in the file's order.

    Points of the film have `xy`, markers `xyz`.
    """
    names = [name.removesuffix(".x") for name in series.columns if name.endswith(".x")]
    return [name for name in names if (f"{name}.z" in series.columns) == (axes == "xyz")]
