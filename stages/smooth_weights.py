"""Bring a take's weights and head motion to the character's rate, filled, filtered and limited.

In this order, because each step needs the one before:

1. Frames that were not tracked are interpolated between their neighbours, or filled by what was
   learnt of the actor's motion, channel by channel; `confidence` is 0 there.
2. Every channel is multiplied by its gain and moved by its offset, so that all that follows is in
   the rig's terms.
3. Blinks and lip closures are found, at the source's rate, where they are sharpest.
4. The multiresolution filter removes what lies above 10 Hz, or a third of the character's rate
   where that is lower than the source's, divided by the channel's smoothing; blinks and closures
   are left. So nothing is aliased by the next step. Weights of layers stay simplex weights: under a
   mask, none falls below 0 and their sum does not grow. Where nothing is fast, smoothing `dynamics`
   takes out instead the jitter that the motion's own statistics tell.
5. Weights are interpolated linearly and rotations along the great circle; at the source's own rate
   every frame comes through unchanged. With a tempo the frame at time t shows the performance at
   `tempo t`.
6. Limits follow, so that they hold in what is solved. Weights of a rig of blendshapes stay in
   0..1 unless the table of channels says otherwise; those of key shapes, layers and recorded
   curves have no limits of themselves.
7. An animator's edits are laid over, cell by cell, and nothing touches them afterwards. Their
   frames are those of the take as delivered.
8. Of all this the frames between the cut's first and last are delivered, with handles, which all
   count the film's frames whatever the tempo; frames keep their numbers, and times and timecode run
   on from the film's first picture at the character's rate.

Without smoothing 3 and 4 are left out. Head motion is not filtered.
"""

import argparse
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from stages import cli
from stages.core import (
    between_poses,
    kept_moments,
    local_trend,
    local_trust,
    motion_filter,
    resample,
    whole_parts,
)
from stages.files import (
    channels,
    dynamics,
    edits,
    errors,
    film,
    lip_gap,
    rate_text,
    rig,
    series,
    solutions,
    take_cut,
    tempo_text,
    weights,
)

HEAD_ROTATION = [f"rotation.{axis}" for axis in "xyzw"]
HEAD_REST = [f"translation.{axis}" for axis in "xyz"] + ["scale"]
FILM = "film"
PARTS = "directed"  # weights of layers: under a mask they are parts of a whole
CUTOFF_HZ = 10.0
CUTOFF_OF_RATE = 1 / 3


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--solution",
        required=True,
        help="key_weights, predicted, solved, directed or mapped .parquet",
    )
    parser.add_argument("--head-motion", required=True, help="head_motion.parquet of the shot")
    parser.add_argument(
        "--expression",
        nargs="*",
        default=[],
        help="expression.parquet, where points drive the take",
    )
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument(
        "--channels", required=True, help="table of gains, offsets and limits, or empty"
    )
    parser.add_argument(
        "--smoothing",
        required=True,
        choices=["none", "multiresolution", "dynamics"],
        help="the motion filter",
    )
    parser.add_argument(
        "--gap-filling",
        choices=["linear", "dynamics"],
        default="linear",
        help="what fills frames that were not tracked",
    )
    parser.add_argument(
        "--dynamics", nargs="*", default=[], help="dynamics.npz, where that fills or smooths"
    )
    parser.add_argument(
        "--lip-points",
        required=True,
        help="upper,lower: points of the expression whose distance shows lip closures, or empty",
    )
    parser.add_argument(
        "--rate", required=True, help="frames per second, such as 30000/1001; film: the source's"
    )
    parser.add_argument(
        "--tempo", default="1", help="how many seconds of the performance pass in one of the take"
    )
    parser.add_argument(
        "--head", required=True, choices=["apply", "none"], help="the actor's head motion"
    )
    parser.add_argument(
        "--edits", nargs="*", default=[], help="edited curves of the take, later files last"
    )
    for flag, text in (
        ("--first-frame", "first frame that is delivered"),
        ("--last-frame", "last frame that is delivered"),
        ("--handles", "frames that are delivered before and after these"),
        ("--start-timecode", "HH:MM:SS:FF of the film's first picture"),
    ):
        parser.add_argument(flag, required=True, help=f"{text}, of the film; or empty")
    parser.add_argument(
        "--video", nargs="*", default=[], help="film in whose frames the cut is counted"
    )
    parser.add_argument("--weights", required=True, help="weights.parquet to write")
    parser.add_argument("--csv", required=True, help="weights.csv to write")
    return parser


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
        message = f"its {len(motion.frame)} frames are not those of {options.solution}"
        raise errors.InputError(path, message + ": run align_head and the solve again")
    turns, rest = (solutions.columns(motion, path, names) for names in (HEAD_ROTATION, HEAD_REST))
    observed = np.isfinite(turns).all(axis=1) & np.isfinite(rest).all(axis=1)
    turns = _filled(path, turns, spherical=True)
    turns = turns / np.linalg.norm(turns, axis=1, keepdims=True)
    return resample.continuous(turns), _filled(path, rest), observed


def _learnt(options: argparse.Namespace, shapes: list[str]) -> dynamics.Dynamics | None:
    """Return what was learnt of the rig's motion, if it is asked for."""
    if "dynamics" not in (options.gap_filling, options.smoothing):
        return None
    if not options.dynamics:
        message = "is needed by gap filling or smoothing dynamics: run learn_dynamics"
        raise errors.InputError("--dynamics", message)
    return dynamics.read(options.dynamics[0], shapes, options.rig)


def _gaps_filled(
    options: argparse.Namespace,
    solved: series.Series,
    asked: channels.Channels,
    learnt: dynamics.Dynamics | None,
    masks: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Return weights and confidence (T, K + 1) without gaps, and what was observed (T,)."""
    path = options.solution
    values = solutions.columns(solved, path, [*asked.names, "confidence"])
    observed = np.isfinite(values).all(axis=1)
    if options.gap_filling == "linear":
        return _filled(path, values), observed
    seen = solutions.observed(solved, path, asked.names)
    for name, known in zip(asked.names, np.isfinite(seen).any(axis=0), strict=True):
        if not known:
            raise errors.InputError(path, f"{name} is nowhere tracked: see the shot's confidence")
    made = between_poses.fill(learnt.motion, seen, float(solved.rate), asked.low, asked.high)
    if solved.meta["kind"] == PARTS:
        made = np.where(np.isfinite(seen), seen, whole_parts.limited(made, seen, masks))
    return np.column_stack([made, np.nan_to_num(values[:, -1])]), observed


def _smoothed(
    options: argparse.Namespace,
    values: np.ndarray,
    source: series.Series,
    rate: Fraction,
    asked: channels.Channels,
    learnt: dynamics.Dynamics | None,
    masks: np.ndarray,
) -> np.ndarray:
    """Filter the curves (T, K), each under its mask (K,), at the source's rate.

    What follows shows them at `rate` frames for each second of the performance.
    """
    if options.smoothing == "none":
        return values
    gap = lip_gap.read("".join(options.expression), options.lip_points, source.frame)
    highest = min(CUTOFF_HZ, rate * CUTOFF_OF_RATE) if rate < source.rate else CUTOFF_HZ
    smooth = asked.strength > 0
    cutoff = np.full(len(smooth), np.inf)
    cutoff[smooth] = float(highest) / asked.strength[smooth]
    per_second = float(source.rate)
    events = kept_moments.find(values, asked.names, asked.keep, per_second, gap)
    whole = masks if source.meta["kind"] == PARTS else None
    made = motion_filter.filtered(values, per_second, cutoff, events, whole)
    if options.smoothing == "dynamics":
        calm = local_trend.smooth(values, per_second, learnt.jitter, asked.strength)
        if rate < source.rate:
            calm = motion_filter.filtered(calm, per_second, cutoff, np.zeros(calm.shape))
        made = local_trust.blended(values, calm, made, events, per_second)
        made = made if whole is None else whole_parts.limited(made, values, whole)
    return made


def main(argv: Sequence[str]) -> None:
    """Read, fill, adjust, filter, resample, limit, write."""
    options = build_parser().parse_args(argv)
    character = rig.read_any(options.rig)
    shapes = character.names
    solved = series.read(options.solution, tuple(solutions.LIMITS))
    asked = channels.read(options.channels, shapes, *solutions.LIMITS[solved.meta["kind"]])
    gaps = np.flatnonzero(np.diff(solved.frame) != 1)
    if len(solved.frame) == 0 or len(gaps):
        where = f"a gap after frame {solved.frame[gaps[0]]}" if len(gaps) else "no frame"
        raise errors.InputError(options.solution, f"has {where}: run merge_capture again")
    turns, rest, head_seen = _head(options, solved.frame)
    learnt = _learnt(options, shapes)
    filled, observed = _gaps_filled(options, solved, asked, learnt, character.mask_index)
    observed &= head_seen
    filled[~observed, -1] = 0.0
    rate = rate_text.read("--rate", options.rate.removesuffix(FILM)) or solved.rate
    tempo = tempo_text.read("--tempo", options.tempo)
    scaled = asked.gain * filled[:, :-1]
    # an addition of zero would lose the sign of a zero
    adjusted = np.where(asked.offset == 0.0, scaled, scaled + asked.offset)
    filled[:, :-1] = _smoothed(
        options, adjusted, solved, rate / tempo, asked, learnt, character.mask_index
    )

    span = int(solved.frame[0]), len(solved.frame), solved.rate * tempo, rate
    frames = resample.covered_frames(*span)
    place = resample.positions(frames, *span)
    moved = resample.linear(filled, *place)
    moved[:, :-1] = np.clip(moved[:, :-1], asked.low, asked.high)
    either = resample.linear(observed.astype(float), *place) < 1.0
    columns = dict(zip([*shapes, "confidence"], moved.T, strict=True))
    columns["confidence"] = np.where(either, 0.0, columns["confidence"])
    columns |= weights.head_columns(resample.slerp(turns, *place), resample.linear(rest, *place))
    for path in options.edits:
        columns = edits.lay_over(path, frames, columns)
    cut_rate = film.nominal_rate(options.video[0]) if options.video else solved.rate
    cells = options.first_frame, options.last_frame, options.handles
    kept = take_cut.kept(options.solution, frames, rate / tempo, cells, cut_rate)
    columns = {name: values[kept] for name, values in columns.items()}
    sources = [options.solution, options.head_motion, options.rig, *options.edits]
    sources += options.dynamics if learnt else []
    sources += [options.channels] if options.channels else []
    sources += options.expression if options.smoothing != "none" and options.lip_points else []
    meta = take_cut.timecode_header(options.start_timecode, cut_rate)
    meta |= {"tempo": str(tempo)} if tempo != 1 else {}
    weights.write(options.weights, options.csv, frames[kept], columns, rate, meta, sources)


if __name__ == "__main__":
    cli.run_stage(main)
