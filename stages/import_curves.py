"""Read the curves of a performance that a phone or another tracker recorded.

They become columns under ARKit's names at a constant rate. Frames that were dropped, or on which no
face was found, are filled from their neighbours and have confidence 0; all others stay at their
times. Values beyond 0 to 1 are kept. What looks wrong is listed with its cure.
"""

import argparse
import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from stages import cli
from stages.core import (
    clock,
    curve_checks,
    frame_clock,
    quaternions,
    regular_frames,
    resample,
    timecode,
)
from stages.files import curve_file, curve_take, delimited, errors, rate_text, series, shape_names

LARGEST = 1e6  # weights beyond it are no weights
DRIFT = 0.25  # of a frame, over the take


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curve-file", required=True, help="Live Link Face, table or JSON")
    parser.add_argument("--names", required=True, help="table of the shapes' names")
    parser.add_argument(
        "--rate", required=True, help="frames per second, such as 60000/1001; empty: the file's"
    )
    parser.add_argument("--curves", required=True, help="curves to write, .parquet")
    parser.add_argument("--head-motion", required=True, help="motion of the head, .parquet")
    parser.add_argument("--checks", required=True, help="what looks wrong, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the curves, put them on a clock, check and write them."""
    arguments = build_parser().parse_args(argv)
    path = arguments.curve_file
    table = shape_names.read(arguments.names)
    take = curve_file.read(path, table)
    try:
        time_s, rate = _clock(take, rate_text.read("--rate", arguments.rate))
        values, measured = regular_frames.regular(_stacked(take), time_s, rate)
    except errors.InputError:
        raise
    except ValueError as error:
        message = f"{error}: correct it, or give its rate"
        raise errors.InputError(path, message) from error
    count = len(take.curves)
    curves = dict(zip(take.curves, values[:, :count].T, strict=True))
    turns = [values[:, start : start + 3] for start in range(count, values.shape[1], 3)]
    angles = dict(zip(take.angles, turns, strict=True))
    findings = _clock_findings(take, time_s, rate, measured)
    yaw = {eye: turn[:, 0] for eye, turn in angles.items()}
    limits = {shape.name: (shape.low, shape.high) for shape in table}
    findings += curve_checks.find(curves, list(limits), limits, yaw)
    rows = [(one.check, one.channel, one.detail, one.cure) for one in findings]
    delimited.write(arguments.checks, ("check", "channel", "detail", "cure"), rows)
    cli.logger.info(
        "%d channels, %d frames at %s/s, %d filled, %d things to look at",
        count, len(measured), rate, np.count_nonzero(~measured), len(findings),
    )  # fmt: skip
    _write(arguments, take, list(limits), curves, angles, measured.astype(float), rate)


def _stacked(take: curve_take.CurveTake) -> np.ndarray:
    """Return curves and then angles as one array (T, C); refuse what can be no weight."""
    for name, values in take.curves.items():
        if (np.abs(values) > LARGEST).any():
            raise ValueError(f"{name} reaches {np.nanmax(np.abs(values)):.4g}")
    return np.column_stack([*take.curves.values(), *take.angles.values()])


def _count(take: curve_take.CurveTake) -> int:
    """Return the number of rows."""
    return len(next(iter(take.curves.values())))


def _clock(take: curve_take.CurveTake, rate: Fraction | None) -> tuple[np.ndarray, Fraction]:
    """Return the times of the rows [s] and the rate of the take."""
    rate = rate or take.rate
    if take.time_s is not None:
        numbers = None if take.frame is None else np.rint(take.frame)
        return take.time_s, rate or frame_clock.rate_of(take.time_s, numbers)
    if rate is None:
        raise ValueError("has no times")
    numbers = np.arange(_count(take)) if take.frame is None else take.frame - take.frame[0]
    return numbers / float(rate), rate


def _clock_findings(
    take: curve_take.CurveTake, time_s: np.ndarray, rate: Fraction, measured: np.ndarray
) -> list[curve_checks.Finding]:
    """Report what the times and names of a file have of their own."""
    found = [
        curve_checks.Finding("unknown", name, "has no name here", "rename it if it should move")
        for name in take.unknown
    ]
    steps = np.diff(time_s)
    counts = np.maximum(np.rint(steps / np.median(steps)), 1) if len(steps) else steps
    counts = counts if take.frame is None else np.diff(take.frame)
    drift_s = abs(steps.sum() - counts.sum() / float(rate))
    if drift_s * float(rate) > DRIFT:
        detail = f"its clock is {drift_s * 1e3:.0f} ms off {rate}/s"
        cure = "its frames were brought to their times; give the rate if it is another"
        found.append(curve_checks.Finding("clock", "", f"{detail} at the end", cure))
    if not measured.all():
        gaps = np.flatnonzero(~measured)
        detail = f"{len(gaps)} frames are not measured, the first is {gaps[0]}"
        found.append(curve_checks.Finding("gaps", "", detail, "they are filled, confidence 0"))
    return found


def _write(
    arguments: argparse.Namespace,
    take: curve_take.CurveTake,
    channels: Sequence[str],
    curves: dict[str, np.ndarray],
    angles: dict[str, np.ndarray],
    confidence: np.ndarray,
    rate: Fraction,
) -> None:
    """Write curves and head motion; channels that the file lacks stay at 0."""
    count, sources = len(confidence), [arguments.curve_file, arguments.names]
    frame, time_s = np.arange(count), clock.frame_times(count, rate)
    meta = {"unit": "1", "missing": [name for name in channels if name not in curves]}
    if take.midnight:
        first = float(take.time_s[0])
        base = timecode.numbers_per_second(rate)
        start = timecode.write(math.floor(first * base + 0.5), rate, drops=False)
        meta |= {"start_timecode": start, "start_s": first}
    columns = {name: curves.get(name, np.zeros(count)) for name in channels}
    columns |= {"confidence": confidence}
    series.write(arguments.curves, "curves", frame, time_s, columns, rate, meta, sources)
    still = np.zeros((count, 3))
    turns = resample.continuous(quaternions.from_angles(angles.get("head", still)))
    motion = dict(zip([f"rotation.{axis}" for axis in "xyzw"], turns.T, strict=True))
    motion |= {f"translation.{axis}": still[:, 0] for axis in "xyz"}
    motion |= {"scale": np.ones(count), "confidence": confidence}
    for eye in ("eye_left", "eye_right"):
        for axis, turn in zip("yxz", angles.get(eye, still).T, strict=True):
            motion[f"{eye}.{axis}"] = turn
    meta = {"units": "face units", "eyes": "turns about the face's axes [rad]"}
    series.write(arguments.head_motion, "head_motion", frame, time_s, motion, rate, meta, sources)


if __name__ == "__main__":
    cli.run_stage(main)
