"""Give a take the nature of its character: how its head turns, and how its face comes after.

The head's turns are taken about other axes, scaled and softly limited; its shifts and scale are the
actor's. Then head and face follow the actor's motion with a lag and a damping ratio: below 1 they
swing past. Speech stays with the sound: blinks, and what moves lips or jaw by the table of channels
or by name, do not follow unless all are asked for; of layers emotion alone does, and gives way
wherever speech or a blink takes the mask (`core.followed_parts`). So lips close when they did;
overshoot belongs to emotion, brows, cheeks and the head. Frames that were not tracked stay gaps, to
be filled afterwards.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import followed_parts, follower, head_shaping, kept_moments, rotation_vectors
from stages.files import channels, errors, rig, series, solutions

# the layer that follows, and the kind of file that has layers
EMOTION, LAYERS = "emotion_", "directed"
ROTATION = [f"rotation.{axis}" for axis in "xyzw"]
SHIFT = [f"translation.{axis}" for axis in "xyz"]
# what a file says of its own making
STAMP = ("kind", "layout_version", "written_with", "sources", "rate")
MOST_LAG_S = 5.0


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    kinds = ", ".join(solutions.LIMITS)
    parser.add_argument("--solution", required=True, help=f"a take, .parquet: {kinds}")
    parser.add_argument("--head-motion", required=True, help="head_motion.parquet of the shot")
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--channels", default="", help="table of the channels, or empty")
    parser.add_argument(
        "--head-gain", default="1 1 1", help="factors of the head's nod, shake and tilt"
    )
    parser.add_argument(
        "--head-limit", default="", help="largest turn of the head [degrees]; empty: none"
    )
    parser.add_argument(
        "--head-axes",
        default="x y z",
        help="which of the actor's turns the character's nod (x), shake (y) and tilt (z) show",
    )
    parser.add_argument(
        "--follow-s", default="0", help="how long the motion stays behind the actor's [s]; 0: not"
    )
    parser.add_argument(
        "--damping", default="1", help="damping ratio; below 1 the motion swings past"
    )
    parser.add_argument(
        "--followed",
        choices=["expression", "all"],
        default="expression",
        help="all: speech, lips and blinks come after too",
    )
    parser.add_argument("--shaped", required=True, help="the take to write, .parquet")
    parser.add_argument("--shaped-head", required=True, help="the head's motion, .parquet")
    return parser


def _numbers(flag: str, text: str, count: int, low: float, high: float) -> np.ndarray:
    """Return the numbers of a cell."""
    try:
        values = np.array([float(word) for word in text.split()])
    except ValueError:
        values = np.zeros(0)
    if len(values) != count or not ((values >= low) & (values <= high)).all():
        what = "a number" if count == 1 else f"{count} numbers separated by blanks"
        raise errors.InputError(flag, f"'{text}' is not {what} from {low:g} to {high:g}")
    return values


def _axes(text: str) -> np.ndarray:
    """Return the axes of a cell."""
    try:
        return head_shaping.read_axes(text)
    except ValueError as error:
        raise errors.InputError("--head-axes", f"{error}: write 'x y z' or 'x -y z'") from error


def _followed(
    options: argparse.Namespace, solved: series.Series, lag: float, damping: float
) -> dict[str, np.ndarray]:
    """Return the columns of the shapes, of which some follow."""
    character = rig.read_any(options.rig)
    shapes = character.names
    values = solutions.columns(solved, options.solution, shapes)
    keep = channels.read(options.channels, shapes, -np.inf, np.inf).keep
    settings = float(solved.rate), lag, damping
    if options.followed == "all":
        chosen = np.ones(len(shapes), bool)
    elif solved.meta["kind"] == LAYERS:
        plain = [shape.partition(".")[2] for shape in shapes]
        chosen = np.array([name.startswith(EMOTION) for name in plain], bool)
        chosen &= [not kind for kind in keep]
    else:
        chosen = np.array([not kind for kind in kept_moments.kinds(shapes, keep)], bool)
    if options.followed != "all" and solved.meta["kind"] == LAYERS:
        made = followed_parts.follow(values, chosen, character.mask_index, *settings)
    else:
        made = np.array(values)
        made[:, chosen] = follower.follow(values[:, chosen], *settings)
    cli.logger.info("%d of %d shapes follow, %g s behind", chosen.sum(), len(shapes), lag)
    return dict(zip(shapes, made.T, strict=True))


def _shaped_head(
    options: argparse.Namespace, lag: float, damping: float
) -> tuple[series.Series, dict[str, np.ndarray]]:
    """Return the head's motion as read, and its columns as shaped."""
    gain = _numbers("--head-gain", options.head_gain, 3, -10.0, 10.0)
    limit = None
    if options.head_limit:
        limit = np.radians(_numbers("--head-limit", options.head_limit, 1, 0.1, 180.0)[0])
    axes, path = _axes(options.head_axes), options.head_motion
    motion = series.read(path, "head_motion")
    if lag == 0.0 and limit is None and (gain == 1.0).all() and (axes == np.eye(3)).all():
        return motion, motion.columns
    turns = rotation_vectors.from_quaternions(solutions.columns(motion, path, ROTATION))
    turns = head_shaping.shaped(turns, axes, gain, limit)
    shifts = solutions.columns(motion, path, SHIFT)
    both = follower.follow(np.hstack([turns, shifts]), float(motion.rate), lag, damping)
    quaternions = rotation_vectors.to_quaternions(both[:, :3])
    moved = dict(zip([*ROTATION, *SHIFT], [*quaternions.T, *both[:, 3:].T], strict=True))
    return motion, motion.columns | moved


def main(argv: Sequence[str]) -> None:
    """Read a take and its head's motion, shape both, write them."""
    options = build_parser().parse_args(argv)
    lag = float(_numbers("--follow-s", options.follow_s, 1, 0.0, MOST_LAG_S)[0])
    damping = float(_numbers("--damping", options.damping, 1, 0.05, 10.0)[0])
    motion, head = _shaped_head(options, lag, damping)
    solved = series.read(options.solution, tuple(solutions.LIMITS))
    columns = solved.columns | _followed(options, solved, lag, damping)
    sources = [options.rig, *([options.channels] if options.channels else [])]
    for path, source, kind, made, target in (
        (options.solution, solved, solved.meta["kind"], columns, options.shaped),
        (options.head_motion, motion, "head_motion", head, options.shaped_head),
    ):
        meta = {name: cell for name, cell in source.meta.items() if name not in STAMP}
        series.write(
            target, kind, source.frame, source.time_s, made, source.rate, meta, [path, *sources]
        )


if __name__ == "__main__":
    cli.run_stage(main)
