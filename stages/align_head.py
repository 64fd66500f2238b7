"""Tell the motion of the head from the motion of the face, against the session's neutral.

Points become face units: the distance of the two unit points on the neutral is 1, the origin is
midway between them, y points up. Of a film, the head motion is fitted as an affine map of the
plane and delivered as translation, rotation and scale (CB02 section 5); the points with the affine
map undone are the expression. Markers have a unit of their own, two unit markers, and a rotation
and translation in space (D06 section 3), which is what is delivered where a shot has markers.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import head_motion, planar_motion, rigid_motion
from stages.files import errors, marker_points, point_set, series

MARKER_CONFIDENCE = "markers.confidence"


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--performance", required=True, help="points of the shot, .parquet")
    parser.add_argument("--neutral", required=True, help="points of the neutral's shot, .parquet")
    parser.add_argument("--neutral-frame", required=True, type=int, help="frame of the neutral")
    parser.add_argument(
        "--unit-points",
        required=True,
        help="two points or contours with a comma between them; their distance is the face unit",
    )
    parser.add_argument(
        "--unit-markers", default="", help="two markers likewise, where the shot has markers"
    )
    parser.add_argument(
        "--origin-marker",
        default="",
        help="marker that is moved to the origin; by default the centroid of those that count",
    )
    parser.add_argument(
        "--head", required=True, choices=["remove", "none"], help="see sessions.tsv"
    )
    parser.add_argument(
        "--head-method",
        default="rigidity",
        choices=list(head_motion.METHODS),
        help="how the motion is found from markers",
    )
    parser.add_argument("--seed", required=True, type=int, help="seed of the draw of point pairs")
    parser.add_argument("--head-motion", required=True, help="motion of each frame, .parquet")
    parser.add_argument("--expression", required=True, help="points without it, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the points, fit the motions, write motion and expression."""
    arguments = build_parser().parse_args(argv)
    performance = series.read(arguments.performance, "performance", np.float32)
    confidence = {
        name: values
        for name, values in performance.columns.items()
        if name.split(".")[-1] == "confidence"
    }
    meta = {"units": "face units", "points": [], "neutral": []}
    motion, expression = {}, {}
    if names := series.point_names(performance):
        motion, expression, neutral = _planar(arguments, performance, names)
        motion["confidence"] = confidence["confidence"]
        meta |= {"points": names, "neutral": neutral.tolist()}
    if series.point_names(performance, "xyz"):
        motion, known, points, markers = _spatial(arguments, performance)
        expression |= points
        confidence[MARKER_CONFIDENCE] = np.where(known, confidence[MARKER_CONFIDENCE], 0.0)
        motion["confidence"] = confidence[MARKER_CONFIDENCE]
        if not names:
            confidence["confidence"] = confidence[MARKER_CONFIDENCE]
        meta |= {"markers": markers.names, "marker_neutral": markers.neutral.tolist()}
    sources = [arguments.performance, arguments.neutral]
    for path, kind, columns in (
        (arguments.head_motion, "head_motion", motion),
        (arguments.expression, "expression", expression | confidence),
    ):
        frame, time_s, rate = performance.frame, performance.time_s, performance.rate
        series.write(path, kind, frame, time_s, columns, rate, meta, sources)


def _spatial(
    arguments: argparse.Namespace, performance: series.Series
) -> tuple[dict, np.ndarray, dict, marker_points.MarkerPoints]:
    """Return the motion in space, where it is known, the markers without it, and the markers."""
    markers = marker_points.read(
        performance,
        arguments.performance,
        arguments.neutral,
        arguments.neutral_frame,
        arguments.unit_markers,
    )
    count = len(performance.frame)
    rotation, translation = np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3))
    if arguments.head == "remove":
        trusted = np.where(markers.mistracked[..., None], np.float32(np.nan), markers.points)
        origin = _origin(arguments, markers.names)
        try:
            rotation, translation = head_motion.solve(
                trusted, markers.neutral, arguments.head_method, origin
            )
        except ValueError as error:
            message = f"{error}: see the marker faults of the shot"
            raise errors.InputError(arguments.performance, message) from error
    known = np.isfinite(rotation).all(axis=(1, 2))
    if not known.all():
        cli.logger.info("too few markers for the head on %d of %d frames", (~known).sum(), count)
    face = rigid_motion.remove(markers.points, rotation, translation)
    points = series.unstack(face, markers.names, "xyz")
    points |= {name: performance.columns[name] for name in (f"{m}.repaired" for m in markers.names)}
    turns, shifts = head_motion.filled(rotation, translation)
    motion = dict(zip([f"rotation.{axis}" for axis in "xyzw"], turns.T, strict=True))
    motion |= dict(zip([f"translation.{axis}" for axis in "xyz"], shifts.T, strict=True))
    return motion | {"scale": np.ones(count)}, known, points, markers


def _origin(arguments: argparse.Namespace, names: Sequence[str]) -> int | None:
    """Return the row of the marker that is moved to the origin, if one is named."""
    if not arguments.origin_marker:
        return None
    if arguments.origin_marker not in names:
        message = f"origin marker {arguments.origin_marker} is not seen on the neutral frame"
        cure = "see origin_marker in sessions.tsv"
        raise errors.InputError(arguments.neutral, f"{message} {arguments.neutral_frame}: {cure}")
    return names.index(arguments.origin_marker)


def _planar(
    arguments: argparse.Namespace, performance: series.Series, names: Sequence[str]
) -> tuple[dict, dict, np.ndarray]:
    """Return the motion in the picture, the points without it, and the neutral's points."""
    neutral_px, ends = _neutral(arguments, names)
    points_px = series.stack(performance, arguments.performance, names).astype(np.float64)
    points, neutral = (_face_units(pixels, ends) for pixels in (points_px, neutral_px))
    if arguments.head == "remove":
        deviation = planar_motion.clip_deviation(points, neutral, _votes(names), arguments.seed)
        linear, translation = planar_motion.fit(points, neutral, deviation)
    else:
        linear = np.tile(np.eye(2), (len(points), 1, 1))
        translation = np.zeros((len(points), 2))
    expression = series.unstack(planar_motion.remove(points, linear, translation), names)
    return _motion_columns(linear, translation), expression, neutral


def _neutral(arguments: argparse.Namespace, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Return the neutral's points (P, 2) and its two unit points (2, 2) [px]."""
    source = series.read(arguments.neutral, "performance")
    if not series.point_names(source):
        message = "the neutral's shot holds no points of a film: choose a neutral_shot with video"
        raise errors.InputError(arguments.neutral, message)
    if arguments.neutral_frame >= len(source.frame):
        message = f"neutral frame {arguments.neutral_frame} is beyond the last frame"
        cure = "correct neutral_frame in sessions.tsv"
        raise errors.InputError(arguments.neutral, f"{message} {len(source.frame) - 1}: {cure}")
    neutral = series.stack(source, arguments.neutral, names)[arguments.neutral_frame]
    if not np.isfinite(neutral).all():
        message = f"the face was not tracked on the neutral frame {arguments.neutral_frame}"
        raise errors.InputError(arguments.neutral, message + ": label it or choose another")
    contours = np.array([point_set.contour_of(name) for name in names])
    ends = []
    for unit_point in (text.strip() for text in arguments.unit_points.split(",")):
        chosen = (np.array(names) == unit_point) | (contours == unit_point)
        if not chosen.any():
            message = f"unit point {unit_point} is no point or contour; see sessions.tsv"
            raise errors.InputError(arguments.neutral, message)
        ends.append(neutral[chosen].mean(axis=0))
    return neutral, np.array(ends)


def _votes(names: Sequence[str]) -> np.ndarray:
    """Return one vote for each contour, shared by its points: lips must not outvote the rest."""
    contours = [point_set.contour_of(name) for name in names]
    return np.array([1 / contours.count(contour) for contour in contours])


def _face_units(pixels: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return points [px, y down] in face units, y up."""
    unit = np.linalg.norm(ends[1] - ends[0])
    return (pixels - ends.mean(axis=0)) / unit * [1, -1]


def _motion_columns(linear: np.ndarray, translation: np.ndarray) -> dict[str, np.ndarray]:
    """Return the columns of a motion in the plane as one in space."""
    angle, scale = planar_motion.decompose(linear)
    zero = np.where(np.isfinite(angle), 0.0, np.nan)
    quaternion = (zero, zero, np.sin(angle / 2), np.cos(angle / 2))
    columns = {f"rotation.{axis}": part for axis, part in zip("xyzw", quaternion, strict=True)} | {
        "translation.x": translation[:, 0],
        "translation.y": translation[:, 1],
    }
    return columns | {"translation.z": zero, "scale": scale}


if __name__ == "__main__":
    cli.run_stage(main)
