"""Bring a take's weights and head motion to the character's rate, with untracked frames filled.

Weights are interpolated linearly and rotations along the great circle; at the source's own rate
every tracked frame comes through unchanged. Frames that were not tracked are interpolated between
their neighbours, and `confidence` is 0 there.
"""

import argparse
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from stages import cli
from stages.core import resample
from stages.files import errors, rig, series, weights

HEAD_ROTATION = [f"rotation.{axis}" for axis in "xyzw"]
HEAD_REST = [f"translation.{axis}" for axis in "xyz"] + ["scale"]
FILM = "film"


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--key-weights", required=True, help="key_weights.parquet of the shot")
    parser.add_argument("--head-motion", required=True, help="head_motion.parquet of the shot")
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument(
        "--rate", required=True, help="frames per second, such as 30000/1001; film: the source's"
    )
    parser.add_argument(
        "--head", required=True, choices=["apply", "none"], help="the actor's head motion"
    )
    parser.add_argument("--weights", required=True, help="weights.parquet to write")
    parser.add_argument("--csv", required=True, help="weights.csv to write")
    return parser


def _rate(text: str, source: Fraction) -> Fraction:
    """Return the rate to bake at."""
    if text in ("", FILM):
        return source
    try:
        rate = Fraction(text)
    except (ValueError, ZeroDivisionError):
        rate = Fraction(0)
    if rate <= 0:
        raise errors.InputError("--rate", f"'{text}' is no rate such as 30 or 30000/1001")
    return rate


def _columns(read: series.Series, path: str, names: list[str]) -> np.ndarray:
    """Return (T, N) values of the named columns."""
    for name in names:
        if name not in read.columns:
            raise errors.InputError(path, f"column {name}, which the rig needs, is missing")
    return np.stack([read.columns[name] for name in names], axis=1)


def _filled(path: str, values: np.ndarray, spherical: bool = False) -> np.ndarray:
    """Interpolate the rows of (T, N) values that hold NaN."""
    known = np.isfinite(values).all(axis=1)
    if not known.any():
        raise errors.InputError(path, "no frame was tracked: see the shot's confidence")
    blend = resample.slerp if spherical else resample.linear
    return blend(values[known], *resample.neighbours(known))


def _head(
    options: argparse.Namespace, frames: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return rotations (T, 4), translation and scale (T, 4), and what was observed (T,)."""
    if options.head == "none":
        still = np.tile([0.0, 0.0, 0.0, 1.0], (len(frames), 1))
        return still, still, np.ones(len(frames), bool)
    path = options.head_motion
    motion = series.read(path, "head_motion")
    if not np.array_equal(motion.frame, frames):
        message = f"its {len(motion.frame)} frames are not those of {options.key_weights}"
        raise errors.InputError(path, message + ": run align_head and solve_weights again")
    turns, rest = _columns(motion, path, HEAD_ROTATION), _columns(motion, path, HEAD_REST)
    observed = np.isfinite(turns).all(axis=1) & np.isfinite(rest).all(axis=1)
    turns = _filled(path, turns, spherical=True)
    turns = turns / np.linalg.norm(turns, axis=1, keepdims=True)
    return resample.continuous(turns), _filled(path, rest), observed


def main(argv: Sequence[str]) -> None:
    """Read, fill, resample, write."""
    options = build_parser().parse_args(argv)
    shapes = rig.read_any(options.rig).names
    solved = series.read(options.key_weights, "key_weights")
    gaps = np.flatnonzero(np.diff(solved.frame) != 1)
    if len(solved.frame) == 0 or len(gaps):
        where = f"a gap after frame {solved.frame[gaps[0]]}" if len(gaps) else "no frame"
        raise errors.InputError(options.key_weights, f"has {where}: run merge_capture again")
    values = _columns(solved, options.key_weights, [*shapes, "confidence"])
    turns, rest, head_seen = _head(options, solved.frame)
    observed = np.isfinite(values).all(axis=1) & head_seen
    filled = _filled(options.key_weights, values)
    filled[~observed, -1] = 0.0

    rate = _rate(options.rate, solved.rate)
    span = int(solved.frame[0]), len(solved.frame), solved.rate, rate
    frames = resample.covered_frames(*span)
    place = resample.positions(frames, *span)
    moved = resample.linear(filled, *place)
    either = resample.linear(observed.astype(float), *place) < 1.0
    columns = dict(zip([*shapes, "confidence"], moved.T, strict=True))
    columns["confidence"] = np.where(either, 0.0, columns["confidence"])
    columns |= weights.head_columns(resample.slerp(turns, *place), resample.linear(rest, *place))
    sources = [options.key_weights, options.head_motion, options.rig]
    weights.write(options.weights, options.csv, frames, columns, rate, sources)


if __name__ == "__main__":
    cli.run_stage(main)
