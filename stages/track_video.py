"""Track the points of a face through a film, one picture after another.

Where no face can be trusted the points are NaN and the confidence is 0; the next pictures are
searched until the face is found again.
"""

import argparse
from collections.abc import Sequence

import cv2
import numpy as np

from stages import cli
from stages.core import face_tracker, tracker_arrays
from stages.files import errors, film, model, series


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tracker", required=True, help="the session's tracker, .npz")
    parser.add_argument("--video", required=True, help="film of the shot")
    parser.add_argument("--tracked", required=True, help="points at the film's times, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the film, track, write the points."""
    cv2.setNumThreads(1)
    arguments = build_parser().parse_args(argv)
    arrays, meta = model.read(arguments.tracker, "tracker")
    try:
        tracker = tracker_arrays.unpack(arrays)
    except ValueError as error:
        raise errors.InputError(arguments.tracker, f"{error}: train it again") from error
    rate = film.nominal_rate(arguments.video)
    promised = film.promised_count(arguments.video)
    progress = cli.Progress("tracking", promised) if promised else None
    lost = np.full(len(meta["points"]), np.nan)
    times, points, trust, face, residual = [], [], [], [], []
    previous = None
    for time_s, picture in film.read_frames(arguments.video):
        found = face_tracker.track(tracker, picture, previous)
        previous = found.points if found else None
        times.append(time_s)
        points.append(found.points if found else np.stack([lost, lost], axis=1))
        trust.append(found.confidence if found else np.zeros(len(lost)))
        face.append(found.face_confidence if found else 0.0)
        residual.append(found.residual if found else np.nan)
        if progress:
            progress.step()
    if not any(face):
        message = f"no face was found in {len(face)} frames: label some frames of this film"
        raise errors.InputError(arguments.video, f"{message}, or check the session of its shot")
    height, width = picture.shape[:2]
    cli.logger.info("face found on %d of %d frames", np.count_nonzero(face), len(face))
    names = meta["points"]
    columns = series.unstack(np.array(points), names)
    columns |= series.unstack(np.array(trust)[..., None], names, ["confidence"])
    columns |= {"confidence": np.array(face), "residual": np.array(residual)}
    series.write(
        arguments.tracked,
        "tracked",
        np.arange(len(times)),
        np.array(times),
        columns,
        rate,
        {"units": "px", "points": names, "picture_size": [width, height]},
        [arguments.tracker, arguments.video],
    )


if __name__ == "__main__":
    cli.run_stage(main)
