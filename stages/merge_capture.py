"""Bring all points of a shot onto one clock of constant, rational rate.

Time is 0 at the film's first picture. The tracked points keep the film's presentation times; from
here on `time_s = frame / rate`. Without markers the rate is the film's nominal one: a film of
variable rate is resampled, one of constant rate stays as it is. With markers the rate is theirs,
from the film's first picture to its last, with their times mapped to the film's by the sync;
markers without a film keep their own clock.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import clock, cubic_resample
from stages.files import errors, film, series, sync

SAME_TIME_S = 1e-3


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    for flag, text in (
        ("--tracked", "points at the film's times, .parquet"),
        ("--markers", "markers on their own clock, .parquet"),
        ("--sync", "how the markers' time maps to the film's, .json"),
        ("--video", "the film, for its length where it was not tracked"),
    ):
        parser.add_argument(flag, nargs="*", default=[], help=f"{text}; none or one")
    parser.add_argument("--performance", required=True, help="points on the clock, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read what was captured, resample, write the performance."""
    arguments = build_parser().parse_args(argv)
    for flag in ("tracked", "markers", "sync", "video"):
        if len(getattr(arguments, flag)) > 1:
            raise ValueError(f"--{flag} takes one file, got {len(getattr(arguments, flag))}")
    tracked = _read(arguments.tracked, "tracked")
    markers = _read(arguments.markers, "markers", np.float32)
    if tracked is None and markers is None:
        where = arguments.performance
        raise errors.InputError(where, "the shot has neither video nor markers: see shots.tsv")
    sources, meta = [*arguments.tracked, *arguments.markers], {"units": "px"}
    if markers is None:
        rate = tracked.rate
        wanted, columns = _of_film(tracked)
    else:
        rate = markers.rate
        wanted, columns = _of_markers(arguments, tracked, markers)
        meta = {"units": "mm"} if tracked is None else {"units": "px", "marker_units": "mm"}
        sources += arguments.sync
    if tracked is not None:
        meta["picture_size"] = tracked.meta.get("picture_size")
    frame = np.arange(len(wanted))
    series.write(arguments.performance, "performance", frame, wanted, columns, rate, meta, sources)


def _read(paths: Sequence[str], kind: str, dtype: type = np.float64) -> series.Series | None:
    """Read a series that the shot may lack."""
    if not paths:
        return None
    found = series.read(paths[0], kind, dtype)
    if not len(found.frame):
        raise errors.InputError(paths[0], "holds no frame: delete it and run again")
    return found


def _of_film(tracked: series.Series) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return times and columns of a shot without markers, on the film's clock."""
    count = clock.frame_count(tracked.time_s[-1], tracked.rate)
    wanted = clock.frame_times(count, tracked.rate)
    columns = tracked.columns
    if count != len(tracked.time_s) or np.abs(wanted - tracked.time_s).max() > SAME_TIME_S:
        columns = _resampled(tracked, wanted)
        cli.logger.info("resampled %d frames to %d", len(tracked.time_s), count)
    return wanted, columns


def _resampled(tracked: series.Series, wanted: np.ndarray) -> dict[str, np.ndarray]:
    """Return the tracked points at other times [s]."""
    values = np.stack(list(tracked.columns.values()), axis=1)
    values = clock.resample(values, tracked.time_s, wanted).astype(np.float32)
    return dict(zip(tracked.columns, values.T, strict=True))


def _of_markers(
    arguments: argparse.Namespace, tracked: series.Series | None, markers: series.Series
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return times and columns of a shot with markers, on a clock of their rate."""
    if tracked is None and not arguments.video:
        wanted = clock.frame_times(len(markers.frame), markers.rate)
        own = markers.columns["confidence"]
        return wanted, markers.columns | {"markers.confidence": own}
    path = arguments.markers[0]
    if not arguments.sync:
        message = "has a film too, but no sync with it: give the sound of both, or"
        raise errors.InputError(path, f"{message} {sync.CURE}")
    found = sync.read(arguments.sync[0])
    last_s = film.last_time(arguments.video[0]) if tracked is None else tracked.time_s[-1]
    count = clock.frame_count(last_s, markers.rate)
    wanted = clock.frame_times(count, markers.rate)
    own_s = (wanted - found.offset_s) / (1 + found.drift_ppm * 1e-6)
    at = cubic_resample.places(own_s * float(markers.rate), len(markers.frame))
    if not at.inside.any():
        start, end = found.offset_s, found.offset_s + len(markers.frame) / float(markers.rate)
        message = f"covers {start:.2f} to {end:.2f} s of the film's time, the film 0 to"
        raise errors.InputError(path, f"{message} {last_s:.2f} s: {sync.CURE}")
    columns = {} if tracked is None else _resampled(tracked, wanted)
    for name, values in markers.columns.items():
        if name == "confidence":
            continue
        bring = cubic_resample.largest if name.endswith(".repaired") else cubic_resample.cubic
        columns[name] = bring(values, at).astype(np.float32)
    trust = cubic_resample.smallest(markers.columns["confidence"], at)
    return wanted, columns | {"confidence": columns.get("confidence", trust)} | {
        "markers.confidence": trust
    }


if __name__ == "__main__":
    cli.run_stage(main)
