"""How the markers' time maps to the film's: the JSON that `sync_audio` writes.

    t_film = (1 + drift_ppm * 1e-6) * t_markers + offset_s

A sync that was refused holds no offset and says why.
"""

import dataclasses
import json
from pathlib import Path

from stages.files import errors

CURE = "set sync_offset_s in shots.tsv"


@dataclasses.dataclass(frozen=True)
class Sync:
    """A map of times that can be relied upon.

    Attributes
    ----------
    offset_s : film's time of the markers' first sample [s]
    drift_ppm : by how much the markers' clock runs slow [parts per million]
    """

    offset_s: float
    drift_ppm: float


def read(path: str | Path) -> Sync:
    """Read a sync.

    Raises
    ------
    errors.InputError
        if it was refused, naming the reason, or is no sync
    """
    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"))
        refused, reason = found["refused"], found["reason"]
        offset, drift = found["offset_s"], found["drift_ppm"]
    except (json.JSONDecodeError, UnicodeDecodeError, KeyError, TypeError) as error:
        raise errors.InputError(path, f"is no sync ({error!r}): delete it, run again") from error
    if refused or offset is None:
        raise errors.InputError(path, f"markers and film are not in step ({reason}): {CURE}")
    return Sync(float(offset), float(drift or 0.0))
