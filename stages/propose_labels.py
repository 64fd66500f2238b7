"""Name the frames of a session that are most worth labelling next, and say why.

A frame helps where the tracker doubts a contour, where the picture is unlike all labelled ones, or
where no face was found; near labelled frames and near each other frames help little.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import label_proposals
from stages.files import errors, labels, point_set, proposal_table, series

DOUBTFUL = 0.7
UNUSUAL = 1.3


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tracked", required=True, nargs="+", help="points of each shot, .parquet")
    parser.add_argument("--shots", required=True, nargs="+", help="name of each shot")
    parser.add_argument("--labelled-shots", required=True, nargs="*", help="shots with labels")
    parser.add_argument("--labels", required=True, nargs="*", help="labels of those, .csv")
    parser.add_argument("--count", type=int, default=12, help="greatest number of frames")
    parser.add_argument("--proposals", required=True, help="ranked frames, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the tracked points, rank the frames, write the proposals."""
    arguments = build_parser().parse_args(argv)
    if len(arguments.tracked) != len(arguments.shots):
        raise ValueError("--tracked and --shots: one of each for every shot")
    if len(arguments.labels) != len(arguments.labelled_shots):
        raise ValueError("--labels and --labelled-shots: one of each for every labelled shot")
    done = {
        (shot, frame)
        for shot, path in zip(arguments.labelled_shots, arguments.labels, strict=True)
        for frame in labels.labelled_frames(path)
    }
    tracked, contours, frames = _read(arguments.tracked)
    places = [(arguments.shots[s], int(f)) for s, f in zip(tracked.shot, frames, strict=True)]
    known = np.array([place in done for place in places])
    ratio = label_proposals.unusual(tracked.residual)
    rows = []
    for number, t in enumerate(label_proposals.rank(tracked, known, arguments.count), start=1):
        shot, frame = places[t]
        cells = [
            str(number),
            shot,
            str(frame),
            f"{tracked.time_s[t]:.3f}",
            f"{tracked.confidence[t].min():.2f}",
            f"{ratio[t]:.2f}" if np.isfinite(tracked.residual[t]) else "",
            _reason(tracked, contours, ratio, t),
        ]
        rows.append(cells)
    proposal_table.write(arguments.proposals, rows)


def _read(paths: Sequence[str]) -> tuple[label_proposals.Tracked, list[str], np.ndarray]:
    """Return the frames of all shots, the contours' names and the frames' numbers."""
    parts, frames, names = [], [], None
    for number, path in enumerate(paths):
        read = series.read(path, "tracked")
        found = series.point_names(read)
        names = found if names is None else names
        if found != names or "residual" not in read.columns:
            message = "has other columns than the session's first shot: track it again"
            raise errors.InputError(path, message)
        owners = np.array([point_set.contour_of(name) for name in names])
        contours = list(dict.fromkeys(owners.tolist()))
        trust = series.stack(read, path, names, ["confidence"])[..., 0]
        trust = np.stack([trust[:, owners == contour].mean(axis=1) for contour in contours], 1)
        points = series.stack(read, path, names)
        shot = np.full(len(points), number)
        parts.append((shot, read.time_s, points, trust, read.columns["residual"]))
        frames.append(read.frame)
    joined = [np.concatenate(part) for part in zip(*parts, strict=True)]
    return label_proposals.Tracked(*joined), contours, np.concatenate(frames)


def _reason(
    tracked: label_proposals.Tracked, contours: list[str], ratio: np.ndarray, t: int
) -> str:
    """Say in plain words why a frame helps."""
    if np.isnan(tracked.points[t]).any():
        return "no face was found: label it if the face is in the picture"
    worst = int(tracked.confidence[t].argmin())
    parts = []
    if tracked.confidence[t, worst] < DOUBTFUL:
        parts.append(f"{contours[worst]} is doubtful")
    if ratio[t] > UNUSUAL:
        parts.append(f"the picture is {ratio[t]:.1f} times as unlike the labelled ones as usual")
    return " and ".join(parts) or "the shape is unlike those of labelled frames"


if __name__ == "__main__":
    cli.run_stage(main)
