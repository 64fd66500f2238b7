"""Choose the frames of an actor that an animator tunes on a rig, and say what pairs still lack.

Where phones are known: the middle of a phone for each viseme and emotion, and extremes of each
emotion (D06 section 4). Then, up to the number that is wanted, the frames that would teach a map
from points to weights most, given these and all pairs tuned so far.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import coverage, partial_projection, pca, reference_frames
from stages.files import (
    actor_points,
    channels,
    driving_points,
    errors,
    pairs,
    phones,
    reference_table,
    rig,
)

# principal axes on which frames are compared: the share of the variance that they hold, at most
EXPLAINED, MOST_AXES = 0.99, 40
# frames nearer than this to a chosen or tuned one are not proposed [s]
APART_S = 0.1


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--shots", required=True, nargs="+", help="names of the basis shots")
    parser.add_argument("--expressions", required=True, nargs="+", help="their expressions")
    parser.add_argument(
        "--emotions", required=True, nargs="+", help="what is played in each, - for nothing"
    )
    parser.add_argument("--phone-shots", nargs="*", default=[], help="those whose phones are known")
    parser.add_argument("--phones", nargs="*", default=[], help="their phones, .parquet")
    parser.add_argument("--points", required=True, choices=list(driving_points.AXES))
    parser.add_argument("--pairs", nargs="*", default=[], help="tables of pairs tuned so far")
    parser.add_argument(
        "--other-shots", nargs="*", default=[], help="shots of other actors: their pairs are left"
    )
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--channels", required=True, help="table of the channels, or ''")
    parser.add_argument("--wanted", required=True, type=int, help="reference frames to choose")
    parser.add_argument(
        "--min-confidence", required=True, type=float, help="frames below are not chosen, 0 to 1"
    )
    parser.add_argument("--references", required=True, help="the frames, .parquet")
    return parser


class _Frames:
    """All frames of the basis shots, one after another."""

    def __init__(self, arguments: argparse.Namespace):
        if len(arguments.emotions) != len(arguments.shots):
            raise errors.InputError("--emotions", "give one for each shot, - where none is played")
        points = actor_points.read(arguments.expressions, arguments.shots, arguments.points)
        first = arguments.expressions[0]
        axes, noise = actor_points.axes(first, points, arguments.min_confidence, MOST_AXES)
        kept = int(np.searchsorted(pca.explained(axes), EXPLAINED)) + 1
        self.rows = points.shots
        self.time_s = points.time_s
        counts = [len(points.shots[shot]) for shot in arguments.shots]
        self.shot = np.repeat(arguments.shots, counts)
        self.place = {shot: np.flatnonzero(self.shot == shot) for shot in arguments.shots}
        self.frame = np.array([frame for shot in arguments.shots for frame in points.shots[shot]])
        self.emotion = np.repeat(
            np.array(["" if name == "-" else name for name in arguments.emotions], object), counts
        )
        sure = np.nan_to_num(points.confidence) >= arguments.min_confidence
        self.eligible = sure & (actor_points.observed_share(points.offsets) >= actor_points.ENOUGH)
        self.features = partial_projection.project(axes, noise, points.offsets)[:, :kept]

    def row(self, shot: str, time_s: float) -> int:
        """Return the row of a shot's frame nearest to a time; the ends are held."""
        own = self.place[shot]
        return int(own[np.abs(self.time_s[own] - time_s).argmin()])

    def beside(self, rows: Sequence[int]) -> np.ndarray:
        """Return which frames (T,) are too near in time to some rows to show anything new."""
        near = np.zeros(len(self.shot), bool)
        for row in rows:
            near |= (self.shot == self.shot[row]) & (
                np.abs(self.time_s - self.time_s[row]) < APART_S
            )
        return near


def main(argv: Sequence[str]) -> None:
    """Read what there is, choose, write."""
    arguments = build_parser().parse_args(argv)
    frames = _Frames(arguments)
    tuned = _tuned(arguments, frames)
    scheme = _scheme(arguments, frames)
    found = scheme[: arguments.wanted]
    if len(scheme) > len(found):
        message = "%d of the %d frames for visemes and extremes are left out: raise references"
        cli.logger.warning(message, len(scheme) - len(found), len(scheme))
    rows = [*tuned, *(each.row for each in found)]
    while len(found) < arguments.wanted:
        free = np.flatnonzero(frames.eligible & ~frames.beside(rows))
        if len(free) == 0:
            break
        candidates, known = frames.features[free], frames.features[rows]
        (best,) = coverage.next_frames(known, candidates, np.ones(len(free), bool), 1)
        rows.append(int(free[best]))
        found.append(reference_frames.Reference(rows[-1], "coverage", ""))
    _write(arguments, frames, tuned, found)


def _tuned(arguments: argparse.Namespace, frames: _Frames) -> dict[int, list[str]]:
    """Return the animators that tuned a frame, by its row."""
    shapes = rig.read_any(arguments.rig).names
    limits = channels.read(arguments.channels, shapes, 0.0, 1.0)
    tuned: dict[int, list[str]] = {}
    for pair in pairs.read(arguments.pairs, frames.rows, arguments.other_shots, limits):
        tuned.setdefault(frames.rows[pair.shot][pair.frame], []).append(pair.animator)
    return tuned


def _scheme(arguments: argparse.Namespace, frames: _Frames) -> list[reference_frames.Reference]:
    """Return the paper's frames, where phones are known."""
    middles = [
        (frames.row(shot, (phone.start_s + phone.end_s) / 2), phone.viseme)
        for shot, path in zip(arguments.phone_shots, arguments.phones, strict=True)
        for phone in phones.read(path)
        if phone.viseme
    ]
    if not middles:
        return []
    given = frames.features, frames.emotion, frames.eligible
    spoken = reference_frames.viseme_frames(given[0], middles, *given[1:])
    chosen = [each.row for each in spoken]
    far = given[2] & ~frames.beside(chosen)
    return spoken + reference_frames.extreme_frames(given[0], chosen, given[1], far)


def _write(
    arguments: argparse.Namespace,
    frames: _Frames,
    tuned: dict[int, list[str]],
    found: Sequence[reference_frames.Reference],
) -> None:
    """Write the chosen frames, and the share of all frames that the pairs do not reach."""
    rows = [each.row for each in found]
    examples, usable = frames.features[list(tuned)], frames.features[frames.eligible]
    reach = np.full(len(found), np.nan)
    header = {"pairs": sum(map(len, tuned.values())), "uncovered": None}
    if tuned:
        header["uncovered"] = coverage.uncovered_share(examples, usable)
    if tuned and found:
        reach = coverage.leverage(examples, frames.features[rows])
    table = [
        {
            "shot": str(frames.shot[each.row]),
            "frame": int(frames.frame[each.row]),
            "time_s": float(frames.time_s[each.row]),
            "source": each.source,
            "viseme": each.viseme,
            "emotion": frames.emotion[each.row],
            "leverage": float(leverage),
            "tuned_by": ",".join(tuned.get(each.row, [])),
        }
        for each, leverage in zip(found, reach, strict=True)
    ]
    sources = [*arguments.expressions, *arguments.phones, *arguments.pairs]
    reference_table.write(arguments.references, table, header, sources)


if __name__ == "__main__":
    cli.run_stage(main)
