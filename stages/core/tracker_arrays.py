"""A tracker as flat arrays with names, and back: what a model file holds."""

import numpy as np

from stages.core import (
    confidence,
    descent,
    eigen_points,
    face_frame,
    face_search,
    face_tracker,
)

PARTS = {"eigen": eigen_points.EigenPoints, "judge": confidence.Judge, "finder": face_search.Finder}


def pack(tracker: face_tracker.FaceTracker) -> dict[str, np.ndarray]:
    """Return the tracker's arrays: `frame.points`, `group.0`, `descent.0.0.weights` and so on."""
    arrays = {"frame.points": tracker.frame.points, "frame.size": np.array(tracker.frame.size)}
    for r, group in enumerate(tracker.groups):
        arrays[f"group.{r}"] = group
    for stage, (weights, biases) in enumerate(
        zip(tracker.cascade.weights, tracker.cascade.biases, strict=True)
    ):
        for r, (weight, bias) in enumerate(zip(weights, biases, strict=True)):
            arrays[f"descent.{stage}.{r}.weights"] = weight
            arrays[f"descent.{stage}.{r}.bias"] = bias
    for part, kind in PARTS.items():
        for field in kind.__dataclass_fields__:
            arrays[f"{part}.{field}"] = np.asarray(getattr(getattr(tracker, part), field))
    return arrays


def unpack(arrays: dict[str, np.ndarray]) -> face_tracker.FaceTracker:
    """Return the tracker that `pack` took apart.

    Raises
    ------
    ValueError
        naming the first array that is missing
    """
    try:
        groups = tuple(arrays[f"group.{r}"] for r in range(_count(arrays, "group.", 1)))
        stages = range(_count(arrays, "descent.", 1))
        cascade = descent.Descent(
            *(
                tuple(
                    tuple(arrays[f"descent.{stage}.{r}.{what}"] for r in range(len(groups)))
                    for stage in stages
                )
                for what in ("weights", "bias")
            )
        )
        parts = {
            part: kind(**{field: arrays[f"{part}.{field}"] for field in kind.__dataclass_fields__})
            for part, kind in PARTS.items()
        }
        width, height = arrays["frame.size"].tolist()
        frame = face_frame.FaceFrame(arrays["frame.points"], (width, height))
    except KeyError as missing:
        raise ValueError(f"array {missing} is missing") from None
    return face_tracker.FaceTracker(frame, groups, cascade=cascade, **parts)


def _count(arrays: dict[str, np.ndarray], prefix: str, place: int) -> int:
    """Return how many numbers follow a prefix at a place of the dotted names."""
    return len({name.split(".")[place] for name in arrays if name.startswith(prefix)})
