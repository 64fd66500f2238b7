"""Models: `.npz` of plain arrays, with a JSON header in the array `meta`. No pickles."""

import io
import json
import zipfile
import zlib
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from stages.files import atomic, errors, provenance

# what a damaged archive may end in
FAULTS = (ValueError, RuntimeError, OSError, zipfile.BadZipFile, zlib.error, EOFError)
EPOCH = (1980, 1, 1, 0, 0, 0)


def write(
    path: str | Path,
    kind: str,
    arrays: dict[str, np.ndarray],
    meta: dict | None = None,
    sources: Iterable[str | Path] = (),
) -> None:
    """Write arrays and a header, byte for byte the same for the same content.

    Parameters
    ----------
    path : the file
    kind : what the model is, for example `tracker`
    arrays : name -> array of numbers or of strings
    meta : names and settings; JSON
    sources : files that it was made from
    """
    header = json.dumps(provenance.stamp(kind, sources) | (meta or {}), sort_keys=True)
    # numpy.savez stamps members with the time of day: so the archive is written here
    with (
        atomic.replacing(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
    ):
        for name, array in (arrays | {"meta": np.array(header)}).items():
            member = io.BytesIO()
            np.lib.format.write_array(member, np.asanyarray(array), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", EPOCH), member.getvalue())


def read(path: str | Path, kind: str) -> tuple[dict[str, np.ndarray], dict]:
    """Read the arrays and the header of a model of one kind.

    Raises
    ------
    errors.InputError
        if the file is no model or of another kind
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except FAULTS as error:
        if isinstance(error, OSError) and error.filename is not None:
            raise  # it is not there, or may not be read
        message = f"no model file ({error}): delete it and run again"
        raise errors.InputError(path, message) from error
    meta = json.loads(str(arrays.pop("meta", "{}")))
    provenance.check(path, meta, kind)
    return arrays, meta
