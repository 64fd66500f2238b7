"""Bring all points of a shot onto one clock of constant, rational rate.

The tracked points keep the film's presentation times; from here on `time_s = frame / rate` with
the film's nominal rate. A film of variable rate is resampled, one of constant rate stays as it is.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import clock
from stages.files import series

SAME_TIME_S = 1e-3


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tracked", required=True, help="points at the film's times, .parquet")
    parser.add_argument("--performance", required=True, help="points on the clock, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the tracked points, resample, write the performance."""
    arguments = build_parser().parse_args(argv)
    tracked = series.read(arguments.tracked, "tracked")
    count = clock.frame_count(tracked.time_s[-1], tracked.rate)
    wanted = clock.frame_times(count, tracked.rate)
    columns = tracked.columns
    if count != len(tracked.time_s) or np.abs(wanted - tracked.time_s).max() > SAME_TIME_S:
        values = np.stack(list(columns.values()), axis=1)
        values = clock.resample(values, tracked.time_s, wanted)
        columns = dict(zip(columns, values.T, strict=True))
        cli.logger.info("resampled %d frames to %d", len(tracked.time_s), count)
    series.write(
        arguments.performance,
        "performance",
        np.arange(count),
        wanted,
        columns,
        tracked.rate,
        {"units": "px", "picture_size": tracked.meta.get("picture_size")},
        [arguments.tracked],
    )


if __name__ == "__main__":
    cli.run_stage(main)
