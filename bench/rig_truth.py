"""Compare the clay head's weights in the example show with those that its generator knows.

Errors are those before smoothing: root mean square over weights, and mean over the vertices that
any shape moves, in mm. `line` is a take that no pair comes from. `still` is what a head errs by
that stays in its neutral.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.spatial import transform

from stages.core import local_shapes
from stages.files import rig, series

TAKES = (
    ("capture", "mia", "clay", "predicted"),
    ("line", "mia", "clay", "predicted"),
    ("line", "mia", "clay_equation", "solved"),
)
EVERY = 4
MOVES_CM = 0.01


def table(show: Path) -> list[str]:
    """Return the lines of two tables: weights of every take, and head rotation of every shot."""
    lines = ["shot     weights    of         weights  vertices  still", f"{'rms [1]':>38}"]
    lines[1] += "     [mm]   [mm]"
    for shot, actor, character, kind in TAKES:
        made = rig.read(show / "results/cast" / actor / character / "rig.npz", "mesh")
        path = show / "results/takes" / shot / character / f"{kind}.parquet"
        figures = _errors(made, series.read(path, kind), _truth(show, shot))
        lines.append(f"{shot:8} {kind:10} {character:13}" + _cells(figures))
    lines += ["", "shot     head rotation error [deg]"]
    lines += [f"{shot:8} {_rotation_error(show, shot):.3f}" for shot in ("capture", "line")]
    return lines


def _truth(show: Path, shot: str) -> dict:
    """Return what the generator knows of a shot."""
    return dict(np.load(show / "data_example/truth" / f"{shot}.npz"))


def _cells(figures: tuple[float, float, float]) -> str:
    """Return the figures of a take."""
    weights, vertices, still = figures
    return f"{weights:7.3f}  {vertices:7.2f}  {still:5.2f}"


def _errors(made: rig.Rig, found: series.Series, truth: dict) -> tuple[float, float, float]:
    """Return the errors of weights [1] and vertices [mm], and the latter of the neutral."""
    given = list(truth["weight_names"])
    order = [given.index(name.split(".")[1]) for name in made.names]
    weights = np.stack([found.columns[name] for name in made.names], axis=1)
    count = min(len(weights), len(truth["weights"]))
    true = truth["weights"][:count, order].astype(float)
    wrong = weights[:count] - true
    deltas = local_shapes.dense(made.deltas)
    moving = np.linalg.norm(deltas, axis=2).max(axis=0) > MOVES_CM
    flat = deltas[:, moving].reshape(len(deltas), -1)
    return (
        float(np.sqrt(np.nanmean(wrong**2))),
        _mean_length(wrong[::EVERY] @ flat),
        _mean_length(true[::EVERY] @ flat),
    )


def _mean_length(moves: np.ndarray) -> float:
    """Return the mean length of moves (T, 3 V) [cm], in mm."""
    return 10 * float(np.nanmean(np.linalg.norm(moves.reshape(len(moves), -1, 3), axis=2)))


def _rotation_error(show: Path, shot: str) -> float:
    """Return the mean angle between the found and the true rotation of the head [deg]."""
    motion = series.read(show / "results/shots" / shot / "head_motion.parquet", "head_motion")
    truth = _truth(show, shot)
    start_s = -float(truth["offset_s"]) if np.isfinite(truth["offset_s"]) else 0.0
    rows = np.round((motion.time_s + start_s) * float(motion.rate)).astype(int)
    inside = rows < len(truth["quaternion"])
    found = np.stack([motion.columns[f"rotation.{axis}"] for axis in "xyzw"], axis=1)[inside]
    true = transform.Rotation.from_quat(truth["quaternion"][rows[inside]].astype(float))
    apart = transform.Rotation.from_quat(found) * true.inv()
    # the neutral's own rotation is the same for all frames
    apart = apart * apart.mean().inv()
    return float(np.degrees(apart.magnitude().mean()))


if __name__ == "__main__":
    sys.stdout.write("\n".join(table(Path(sys.argv[1] if len(sys.argv) > 1 else "."))) + "\n")
