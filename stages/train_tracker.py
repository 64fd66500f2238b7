"""Learn a session's tracker from the contours that a person labelled on a handful of frames.

The contours are resampled evenly between their corners, the labelled pictures are pre-warped and
morphed into each other, and pixels and points are analysed together (CB02 section 3). The method
`eigen_points` is that and no more; `eigen_points_descent` refines each point afterwards.
"""

import argparse
from collections.abc import Sequence

import cv2
import numpy as np

from stages import cli
from stages.core import contours as contour_points
from stages.core import point_groups, similarity, tracker_arrays, tracker_training
from stages.files import errors, film, labels, model, point_set


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--videos", required=True, nargs="+", help="labelled films")
    parser.add_argument("--labels", required=True, nargs="+", help="labels of each film, .csv")
    parser.add_argument("--shots", required=True, nargs="+", help="name of each film's shot")
    parser.add_argument("--point-set", required=True, help="contours and their points, .tsv")
    parser.add_argument(
        "--method",
        choices=tracker_training.METHODS,
        default="eigen_points_descent",
        help="eigen_points is the published one",
    )
    parser.add_argument("--seed", required=True, type=int, help="seed of the perturbations")
    parser.add_argument("--tracker", required=True, help="the tracker, .npz")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read films and labels, train, write the tracker."""
    cv2.setNumThreads(1)
    arguments = build_parser().parse_args(argv)
    if not len(arguments.videos) == len(arguments.labels) == len(arguments.shots):
        raise ValueError("--videos, --labels and --shots: one of each for every film")
    point_contours = point_set.read(arguments.point_set)
    pictures, shapes, origins, names = [], [], [], None
    corners: dict[str, int] = {}
    for shot, video, table in zip(arguments.shots, arguments.videos, arguments.labels, strict=True):
        labelled = labels.read(table, point_contours)
        shown = film.frames_at(video, labelled, table)
        for frame, drawn in labelled.items():
            _check_corners(table, frame, drawn, corners)
            found, shape = _shape(table, frame, drawn, point_contours)
            names = found if names is None else names
            if found != names:
                message = f"frame {frame} has other points than the first labelled frame"
                raise errors.InputError(table, f"{message}: give {arguments.point_set} counts")
            _check_inside(table, frame, found, shape, shown[frame])
            pictures.append(shown[frame])
            shapes.append(shape)
            origins.append([shot, frame])
    if len(pictures) < tracker_training.LEAST_LABELLED:
        message = f"{len(pictures)} labelled frames are too few: label a dozen, at least"
        raise errors.InputError(arguments.labels[0], f"{message} {tracker_training.LEAST_LABELLED}")
    cli.logger.info("learning from %d labelled frames of %d points", len(shapes), len(names))
    shapes = np.array(shapes)
    owners = [point_set.contour_of(name) for name in names]
    groups = point_groups.nested(owners, similarity.mean_shape(shapes, 1.0))
    tracker = tracker_training.train(pictures, shapes, groups, arguments.method, arguments.seed)
    height, width = pictures[0].shape[:2]
    model.write(
        arguments.tracker,
        "tracker",
        tracker_arrays.pack(tracker),
        {
            "points": names,
            "method": arguments.method,
            "seed": arguments.seed,
            "labelled": origins,
            "picture_size": [width, height],
        },
        [*arguments.videos, *arguments.labels, arguments.point_set],
    )


def _check_corners(
    table: str, frame: int, drawn: dict[str, labels.Polyline], known: dict[str, int]
) -> None:
    """Refuse a contour with other corners than on the first labelled frame; `known` remembers."""
    for name, line in drawn.items():
        count = known.setdefault(name, len(line.corners))
        if len(line.corners) != count:
            message = f"frame {frame}: contour {name} has {len(line.corners)} corners"
            raise errors.InputError(table, f"{message}, the first labelled frame has {count}")


def _shape(
    table: str, frame: int, drawn: dict[str, labels.Polyline], wanted: list[point_set.Contour]
) -> tuple[list[str], np.ndarray]:
    """Return the names and the places of a labelled frame's points, resampled."""
    names, points = [], []
    for contour in wanted:
        line = drawn[contour.name]
        placed = line.points
        if contour.count is not None and contour.kind != "point":
            try:
                placed = contour_points.resample(
                    line.points, contour.kind == "closed", line.corners, contour.count
                )
            except ValueError as error:
                message = f"frame {frame}, contour {contour.name}: {error}"
                raise errors.InputError(table, message) from error
        names += point_set.point_names(contour, len(placed))
        points.append(placed)
    return names, np.concatenate(points)


def _check_inside(
    table: str, frame: int, names: list[str], shape: np.ndarray, picture: np.ndarray
) -> None:
    """Refuse a point that lies outside the picture."""
    height, width = picture.shape[:2]
    outside = ((shape < 0) | (shape > [width, height])).any(axis=1)
    if outside.any():
        p = int(np.flatnonzero(outside)[0])
        message = (
            f"frame {frame}: {names[p]} at ({shape[p, 0]:.1f}, {shape[p, 1]:.1f}) lies outside "
            f"the picture of {width}x{height}; move it, or give the film that was labelled"
        )
        raise errors.InputError(table, message)


if __name__ == "__main__":
    cli.run_stage(main)
