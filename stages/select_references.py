"""Choose the frames of an actor that an animator tunes on a rig, and say what pairs still lack.

Where phones are known: the middle of a phone for each viseme and emotion, and extremes of each
emotion (D06 section 4). Then, up to the number that is wanted, the frames that would teach a map
from points to weights most, given these and all pairs tuned so far.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import coverage, pca, reference_frames
from stages.files import channels, driving_points, errors, pairs, phones, reference_table, rig

# principal axes on which frames are compared: the share of the variance that they hold
EXPLAINED = 0.99
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
        read = [driving_points.read(path, arguments.points) for path in arguments.expressions]
        counts = [len(each.frame) for each in read]
        starts = np.cumsum([0, *counts[:-1]]).tolist()
        self.first = dict(zip(arguments.shots, starts, strict=True))
        self.count = dict(zip(arguments.shots, counts, strict=True))
        self.rate = dict(zip(arguments.shots, (each.rate for each in read), strict=True))
        self.shot = np.repeat(arguments.shots, counts)
        self.frame = np.concatenate([each.frame for each in read])
        self.time_s = np.concatenate([each.time_s for each in read])
        self.emotion = np.repeat(
            np.array(["" if name == "-" else name for name in arguments.emotions], object), counts
        )
        for path, each in zip(arguments.expressions, read, strict=True):
            if each.names != read[0].names:
                message = f"has other points than {arguments.expressions[0]}"
                raise errors.InputError(path, message + ": give shots of one marker set together")
        points = np.concatenate([each.points for each in read])
        whole = np.isfinite(points).all(axis=(1, 2))
        confidence = np.nan_to_num(np.concatenate([each.confidence for each in read]))
        self.eligible = whole & (confidence >= arguments.min_confidence)
        if np.count_nonzero(self.eligible) < 2:
            message = f"no two frames show all points with confidence {arguments.min_confidence}"
            raise errors.InputError(arguments.expressions[0], message + ": lower min_confidence")
        self.features = self._features(points, whole)

    def _features(self, points: np.ndarray, whole: np.ndarray) -> np.ndarray:
        """Return the frames (T, C) on their main principal axes; zero where points lack."""
        flat = points.reshape(len(points), -1)
        axes = pca.fit(flat[self.eligible])
        kept = int(np.searchsorted(pca.explained(axes), EXPLAINED)) + 1
        features = np.zeros((len(flat), min(kept, len(axes.components))))
        features[whole] = pca.project(axes, flat[whole])[:, : features.shape[1]]
        return features

    def row(self, shot: str, time_s: float) -> int:
        """Return the row of a shot's frame nearest to a time; the ends are held."""
        frame = min(max(round(time_s * self.rate[shot]), 0), self.count[shot] - 1)
        return self.first[shot] + frame

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
    known = {shot: range(count) for shot, count in frames.count.items()}
    tuned: dict[int, list[str]] = {}
    for pair in pairs.read(arguments.pairs, known, arguments.other_shots, limits):
        tuned.setdefault(frames.first[pair.shot] + pair.frame, []).append(pair.animator)
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
