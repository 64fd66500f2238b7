"""Offer recorded curves as tuned pairs: their weights at the frames that an animator would tune.

The table is what an animator writes by hand, ready to be copied into the character's folder of
pairs. Frames on which the curves were not measured are left out; weights beyond the limits of the
character's channels, 0 to 1 unless its table says otherwise, are brought to them.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import clock
from stages.files import channels, delimited, errors, reference_table, series

DIGITS = 6


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mapped", nargs="+", required=True, help="weights of shots, .parquet")
    parser.add_argument("--shots", nargs="+", required=True, help="names of these shots")
    parser.add_argument("--references", required=True, help="frames to tune, .parquet")
    parser.add_argument(
        "--channels", required=True, help="table of the character's channels, or empty"
    )
    parser.add_argument("--pairs", required=True, help="table of pairs to write, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read weights and reference frames, write a row for each frame that is covered."""
    arguments = build_parser().parse_args(argv)
    if len(arguments.mapped) != len(arguments.shots):
        counts = f"{len(arguments.mapped)} files for {len(arguments.shots)} shots"
        raise errors.InputError("--mapped", f"{counts}: give one for each")
    wanted, _ = reference_table.read(arguments.references)
    rows: list[list[str]] = []
    limits = None
    for path, shot in zip(arguments.mapped, arguments.shots, strict=True):
        mapped = series.read(path, "mapped")
        shapes = [name for name in mapped.columns if name != "confidence"]
        limits = limits or channels.read(arguments.channels, shapes, 0.0, 1.0)
        if shapes != limits.names:
            raise errors.InputError(path, "is of another rig than the first: map it again")
        own = [row for row in wanted if row["shot"] == shot]
        rows += _rows(shot, own, mapped, limits)
    if not rows:
        message = "no frame to tune lies where curves were measured: are they of these shots?"
        raise errors.InputError(arguments.references, message)
    cli.logger.info("%d of %d frames have curves", len(rows), len(wanted))
    plain = [name.partition(".")[2] for name in limits.names]
    delimited.write(arguments.pairs, ("shot", "frame", *plain), rows)


def _rows(
    shot: str, wanted: Sequence[dict], mapped: series.Series, limits: channels.Channels
) -> list[list[str]]:
    """Return the rows of a shot, its weights at the times of the wanted frames."""
    if not wanted:
        return []
    times = np.array([row["time_s"] for row in wanted])
    columns = np.stack([mapped.columns[name] for name in (*limits.names, "confidence")], axis=1)
    values = clock.resample(columns, mapped.time_s, times)
    values[:, :-1] = np.clip(values[:, :-1], limits.low, limits.high)
    inside = (times >= mapped.time_s[0]) & (times <= mapped.time_s[-1])
    return [
        [shot, str(row["frame"]), *(f"{weight:.{DIGITS}g}" for weight in value[:-1])]
        for row, value, known in zip(wanted, values, inside, strict=True)
        if known and value[-1] > 0
    ]


if __name__ == "__main__":
    cli.run_stage(main)
