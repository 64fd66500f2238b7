"""`dynamics.npz`: how an actor's takes move a rig's shapes, learnt from some of them.

Arrays, over the K shapes: `durations` (D,) [s], `coefficients` (D, F, TERMS), `deviations` (N, K),
`block` (N,), `low`, `high` (K,), as in `core.between_poses`; `jitter` (R, K), as in
`core.local_trend`. The header: `shapes`, K names `<mask>.<shape>`.
"""

import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from stages.core import between_poses
from stages.files import errors, model

KIND = "dynamics"


@dataclasses.dataclass(frozen=True)
class Dynamics:
    """What was learnt of a rig's motion.

    Attributes
    ----------
    shapes : the K shapes, `<mask>.<shape>`
    motion : between poses
    jitter : (R, K) float array, how well ratios of motion to jitter foretell frames
    """

    shapes: list[str]
    motion: between_poses.BetweenPoses
    jitter: np.ndarray


def write(path: str | Path, learnt: Dynamics, sources: Iterable[str | Path] = ()) -> None:
    """Write what was learnt."""
    arrays = learnt.motion._asdict() | {"jitter": learnt.jitter}
    # single precision is what the curves have themselves
    arrays["deviations"] = arrays["deviations"].astype(np.float32)
    model.write(path, KIND, arrays, {"shapes": learnt.shapes}, sources)


def read(path: str | Path, shapes: Sequence[str], rig_path: str | Path) -> Dynamics:
    """Read what was learnt for a rig with some shapes.

    Raises
    ------
    errors.InputError
        if the file is of another kind or was learnt for another rig
    """
    arrays, header = model.read(path, KIND)
    if header["shapes"] != list(shapes):
        message = f"was learnt for {len(header['shapes'])} shapes, not for the {len(shapes)} of"
        raise errors.InputError(path, f"{message} {rig_path}: run learn_dynamics again")
    fields = {name: arrays[name] for name in between_poses.BetweenPoses._fields}
    fields["deviations"] = fields["deviations"].astype(float)
    return Dynamics(list(shapes), between_poses.BetweenPoses(**fields), arrays["jitter"])
