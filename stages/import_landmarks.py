"""Read the points of a face that another tracker found in a film.

They become what this tracker would write: points by the names of their contours, in pixels, on the
pictures of the film. Where the file has no row, or a row without a face, the points are NaN and the
confidence is 0. With a film its presentation times count; without one the file's own times do, or
its frame numbers and a rate. A rate is never told from the number of rows.
"""

import argparse
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from stages import cli
from stages.core import film_frames
from stages.files import errors, film, landmark_file, landmark_map, landmark_take, rate_text, series

NO_CLOCK = "give its film, or the rate, or track it again with frame numbers or times"


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--landmarks", required=True, help="file or folder of the other tracker")
    parser.add_argument("--video", nargs="*", default=[], help="film of the shot; none or one")
    parser.add_argument(
        "--maps", nargs="+", required=True, help="tables index, point, called after their tracker"
    )
    parser.add_argument(
        "--rate", required=True, help="frames per second, such as 30000/1001; empty: as found"
    )
    parser.add_argument("--tracked", required=True, help="points at the film's times, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the landmarks, name them, put them on the film's pictures, write them."""
    arguments = build_parser().parse_args(argv)
    if len(arguments.video) > 1:
        raise ValueError(f"--video takes one film, got {len(arguments.video)}")
    path, video = arguments.landmarks, (arguments.video or [None])[0]
    take = landmark_file.read(path)
    names, points, sources = _named(take, arguments)
    placement, rate = _placed(take, path, video, rate_text.read("--rate", arguments.rate))
    size = _size(take, path, video)
    try:
        pixels = landmark_take.in_pixels(points, size) + take.shift
    except ValueError as error:
        raise errors.InputError(path, f"{error}: give its film") from error
    _check_inside(path, pixels, size)
    lost = placement.row < 0
    pixels = np.where(lost[:, None, None], np.nan, pixels[placement.row])
    face = np.where(lost, 0.0, take.confidence[placement.row])
    found = np.isfinite(pixels).all(axis=2)
    pixels = np.where(found[..., None], pixels, np.nan)
    face = np.where(found.any(axis=1), face, 0.0)
    cli.logger.info("face found on %d of %d frames", np.count_nonzero(face), len(face))
    columns = series.unstack(pixels, names)
    columns |= series.unstack((found * face[:, None])[..., None], names, ["confidence"])
    columns |= {"confidence": face}
    meta = {"units": "px", "points": names, "picture_size": None if size is None else list(size)}
    frame, time_s = placement.frame, placement.time_s
    series.write(arguments.tracked, "tracked", frame, time_s, columns, rate, meta, sources)


def _named(
    take: landmark_take.LandmarkTake, arguments: argparse.Namespace
) -> tuple[list[str], np.ndarray, list[str]]:
    """Return the points that have names here: names, (T, P, 2) array, and the files used."""
    path = arguments.landmarks
    sources = [*landmark_file.sources(path), *arguments.video]
    if "" in take.choices:
        return list(take.names), take.choices[""], sources
    tracker, chosen = landmark_map.choose(arguments.maps, list(take.choices), path)
    points = take.choices[tracker]
    indices = landmark_map.read(chosen)
    beyond = [name for name, index in indices.items() if index >= points.shape[1]]
    if len(beyond) == len(indices):
        raise errors.InputError(chosen, f"names no point of {path}, which has {points.shape[1]}")
    if beyond:
        cli.logger.warning("%s: has no point for %s", path, ", ".join(beyond))
    names = [name for name in indices if name not in beyond]
    return names, points[:, [indices[name] for name in names]], [*sources, chosen]


def _placed(
    take: landmark_take.LandmarkTake, path: str, video: str | None, rate: Fraction | None
) -> tuple[film_frames.Placement, Fraction]:
    """Return the pictures that the rows belong to, and their rate."""
    count = len(take.confidence)
    numbers = (take.frame, take.first, take.time_s)
    try:
        if video is None:
            return film_frames.alone(count, *numbers, rate or take.rate)
        placement = film_frames.on_film(film.picture_times(video), count, *numbers)
    except errors.InputError:
        raise
    except ValueError as error:
        cure = NO_CLOCK if video is None else f"is {video} its film?"
        raise errors.InputError(path, f"{error}: {cure}") from error
    return placement, rate or film.nominal_rate(video)


def _size(
    take: landmark_take.LandmarkTake, path: str, video: str | None
) -> tuple[float, float] | None:
    """Return the size of the picture; refuse a file that was made of another."""
    if video is None:
        return take.size
    size = film.size(video)
    if take.size is not None and take.size != size:
        sizes = f"{take.size[0]:g}x{take.size[1]:g}, the film has {size[0]}x{size[1]}"
        raise errors.InputError(path, f"was made of pictures of {sizes}: is {video} its film?")
    return size


def _check_inside(path: str, pixels: np.ndarray, size: tuple[float, float] | None) -> None:
    """Refuse points most of which lie outside the picture."""
    if size is None or not np.isfinite(pixels).any():
        return
    middle = np.nanmedian(pixels, axis=(0, 1))
    if (middle < 0).any() or (middle > size).any():
        place = f"({middle[0]:.4g}, {middle[1]:.4g}), outside the picture {size[0]:g}x{size[1]:g}"
        raise errors.InputError(path, f"its points lie round {place}: were they made of this film?")


if __name__ == "__main__":
    cli.run_stage(main)
