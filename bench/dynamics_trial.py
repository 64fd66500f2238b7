"""Try what fills gaps of lost tracking, and what takes jitter out: `--data FOLDER`.

`python -m bench.dynamics_trial --data FOLDER`, the folder as in `rig_take`. The recorded track is
read as the project reads it (`import_curves`: a regular clock, 30 frames/s, rows that the recorder
dropped are filled and are not tested). Two ways to divide it: learnt from the first 60 %, and from
two of every three stretches of 13 s. Settings of all learnt ways were chosen within the first 60 %
(learnt from its first 40 of 60 parts, tried on the last 20). In the unseen part stretches of 5, 15
and 30 frames are removed at random, a second apart, several times over. Printed:

- whole frames lost: RMS error over all channels and over those that move (standard deviation above
  0.05 in the unseen part); in how many gaps the error is below the linear one's; jitter at the
  seams, RMS of what is wrong with the second difference at the two frames on each side of both
  ends; blinks whose peak was lost, and how many come back with half their height, of all
- the same for each group of channels: the linear, the best cubic, and the learnt motion
- some channels lost, RMS over those of them that move
- another actor's take, if it is there: what was learnt from the first, on it
- jitter: RMS error of all channels with white noise of some sizes, at 30, 60 and 120 frames/s (a
  monotone cubic through the track), raw and filtered
"""

import argparse
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import scipy.interpolate
import scipy.signal

from bench import gap_fillers, linear_dynamics
from stages import import_curves
from stages.core import local_trend, local_trust, motion_filter
from stages.files import series

TRACK, OTHER = "livelink/alex_rom_3.csv", "livelink/MySlate_3_Jason_Millers_iPhone.csv"
NAMES = Path(__file__).parents[1] / "stages" / "tables" / "shape_names.tsv"
RATE, CONTEXT, SEEDS = 30.0, 30, 8
LENGTHS = (5, 15, 30)
SHARE, BLOCK = 0.6, 390
MOVES, BLINK = 0.05, 0.3
GROUPS = {
    "brows": ("brow",),
    "lids": ("eyeBlink", "eyeSquint", "eyeWide"),
    "gaze": ("eyeLook",),
    "jaw, lips": ("jaw", "mouth"),
    "cheeks, nose": ("cheek", "nose"),
}
NOISES, NOISE_RATES = (0.0, 0.005, 0.01, 0.02), (30, 60, 120)


class Track(NamedTuple):
    """Hold channels (K names), curves (T, K), which frames were measured (T,), and the rate."""

    names: list[str]
    values: np.ndarray
    measured: np.ndarray
    rate: float


class Split(NamedTuple):
    """Hold stretches to learn from, and the rows that are not seen (from, to) of each stretch."""

    name: str
    learnt: list[np.ndarray]
    unseen: list[tuple[int, int]]


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder with the recorded tracks")
    folder = Path(parser.parse_args().data)
    track = read(folder / TRACK)
    for split in splits(track):
        fillers = ways(split.learnt, track.rate, track.rate)
        whole_frames(track, split, fillers)
        some_channels(track, split, fillers)
    if (folder / OTHER).is_file():
        another(track, read(folder / OTHER))
    jitter(track)


def read(path: Path) -> Track:
    """Return a track as the project reads it."""
    with tempfile.TemporaryDirectory() as made:
        out = {name: f"{made}/{name}" for name in ("curves", "head-motion", "checks")}
        words = [f"--{name}={file}" for name, file in out.items()]
        import_curves.main(["--curve-file", str(path), "--names", str(NAMES), "--rate=", *words])
        curves = series.read(out["curves"], "curves")
    names = [name for name in curves.columns if name != "confidence"]
    values = np.stack([curves.columns[name] for name in names], axis=1)
    return Track(names, values, curves.columns["confidence"] > 0, float(curves.rate))


def splits(track: Track) -> list[Split]:
    """Return the two ways to divide a track."""
    count = len(track.values)
    edge = int(SHARE * count)
    blocks = [(first, min(first + BLOCK, count)) for first in range(0, count, BLOCK)]
    learnt = [track.values[slice(*block)] for number, block in enumerate(blocks) if number % 3 != 1]
    return [
        Split("learnt from the first 60 %", [track.values[:edge]], [(edge, count)]),
        Split("learnt from two of three stretches of 13 s", learnt, blocks[1::3]),
    ]


def ways(learnt: list[np.ndarray], learnt_rate: float, rate: float) -> dict[str, Callable]:
    """Return every way to fill a gap."""
    rates = [learnt_rate] * len(learnt)
    return {
        "linear": gap_fillers.linear,
        "cubic, Hermite": gap_fillers.hermite,
        "cubic, monotone": gap_fillers.monotone,
        "cubic spline": gap_fillers.spline,
        "linear system by EM": gap_fillers.system(learnt),
        "Gaussian process of components": gap_fillers.kriging(learnt),
        "ridge of components": gap_fillers.ridge(learnt),
        "nearest stretches": gap_fillers.nearest(learnt),
        "learnt motion": gap_fillers.learnt(learnt, rates, rate),
    }


def gaps(track: Track, unseen: list[tuple[int, int]], length: int) -> list[int]:
    """Return first rows of stretches that are removed, at random, over all seeds."""
    found = []
    for seed in range(SEEDS):
        rng = np.random.default_rng(seed)
        for start, end in unseen:
            row = start + CONTEXT + rng.integers(0, CONTEXT)
            while row + length + CONTEXT <= end:
                around = slice(row - CONTEXT, row + length + CONTEXT)
                if track.measured[around].all():
                    found.append(int(row))
                row += length + CONTEXT + rng.integers(0, CONTEXT)
    return found


def moving(track: Track, unseen: list[tuple[int, int]]) -> np.ndarray:
    """Return which channels (K,) move in the unseen part."""
    return np.concatenate([track.values[slice(*part)] for part in unseen]).std(axis=0) > MOVES


def errors_of(track, rows, length, filler, lost=None):
    """Return what is wrong (G, length + 4, K) with each gap and two frames on each side."""
    made = []
    lost = lost or [np.ones(track.values.shape[1], bool)]
    for number, row in enumerate(rows):
        truth = track.values[row - CONTEXT : row + length + CONTEXT]
        given = truth.copy()
        chosen = lost[number % len(lost)]
        given[CONTEXT : CONTEXT + length, chosen] = np.nan
        wrong = np.clip(filler(given), 0, 1) - np.clip(truth, 0, 1)
        wrong[:, ~chosen] = np.nan
        made.append(wrong[CONTEXT - 2 : CONTEXT + length + 2])
    return np.array(made)


def whole_frames(track: Track, split: Split, fillers: dict[str, Callable]) -> None:
    """Print how well whole frames are filled."""
    mobile = moving(track, split.unseen)
    for length in LENGTHS:
        rows = gaps(track, split.unseen, length)
        _say(f"\n{split.name}; {length} frames lost, {len(rows)} gaps")
        _say(f"{'':32}    all  moving  better   seams  blinks")
        wrong = {name: errors_of(track, rows, length, one) for name, one in fillers.items()}
        straight = _rms(wrong["linear"][:, 2:-2], (1, 2))
        for name, error in wrong.items():
            inner = error[:, 2:-2]
            better = np.mean(_rms(inner, (1, 2)) < straight)
            seams = np.diff(error, 2, axis=1)[:, [0, 1, -2, -1]]
            kept, count = _blinks(track, rows, length, inner)
            cells = f"{_rms(inner):8.4f}{_rms(inner[..., mobile]):8.4f}{better:8.2f}"
            _say(f"{name:32}{cells}{_rms(seams):8.4f}{kept:5d}/{count}")
        best = min(
            (name for name in wrong if "cubic" in name), key=lambda n: _rms(wrong[n][:, 2:-2])
        )
        for group, words in GROUPS.items():
            own = mobile & [name.startswith(words) for name in track.names]
            if own.any():
                three = ("linear", best, "learnt motion")
                cells = ", ".join(f"{n} {_rms(wrong[n][:, 2:-2][..., own]):.4f}" for n in three)
                _say(f"    {group}, {own.sum()} moving: {cells}")


def _blinks(track, rows, length, inner):
    """Return how many lost peaks of blinks come back with half their height, and how many."""
    kept = count = 0
    for channel in (i for i, name in enumerate(track.names) if name.startswith("eyeBlink")):
        curve = track.values[:, channel]
        peaks, found = scipy.signal.find_peaks(curve, prominence=BLINK, width=(0, 0.6 * track.rate))
        for row, error in zip(rows, inner[..., channel], strict=True):
            inside = (peaks >= row) & (peaks < row + length)
            heights = found["prominences"][inside]
            kept += int(np.sum(-error[peaks[inside] - row] < 0.5 * heights))
            count += len(heights)
    return kept, count


def some_channels(track: Track, split: Split, fillers: dict[str, Callable]) -> None:
    """Print how well channels are filled while others were observed."""
    named = {
        "left eye and brow": lambda n: "Left" in n and n.startswith(("eye", "brow")),
        "right half": lambda n: "Right" in n,
        "jaw and lips": lambda n: n.startswith(("jaw", "mouth")),
        "eyes and brows": lambda n: n.startswith(("eye", "brow")),
    }
    count = len(track.names)
    lost = {
        label: [np.array([test(name) for name in track.names])] for label, test in named.items()
    }
    halves = [np.random.default_rng(seed).permutation(count) < count // 2 for seed in range(100)]
    lost["a random half"] = halves
    mobile = moving(track, split.unseen)
    three = ("linear", "cubic, Hermite", "cubic, monotone", "linear system by EM", "learnt motion")
    _say(f"\n{split.name}; some channels lost\n{'':27}" + "".join(f"{name:>21}" for name in three))
    for label, chosen in lost.items():
        for length in LENGTHS[1:]:
            rows = gaps(track, split.unseen, length)
            wrong = [errors_of(track, rows, length, fillers[name], chosen) for name in three]
            cells = "".join(f"{_rms(one[:, 2:-2][..., mobile]):21.4f}" for one in wrong)
            _say(f"{label:20}{length:4} f{cells}")


def another(track: Track, other: Track) -> None:
    """Print how what was learnt from one actor does on another."""
    common = [name for name in track.names if name in other.names]
    values = other.values[:, [other.names.index(name) for name in common]]
    taken = other._replace(names=common, values=values)
    learnt = [track.values[:, [track.names.index(name) for name in common]]]
    whole = Split(f"learnt from one actor, tried on another at {taken.rate:g} frames/s", learnt, [])
    fillers = ways(learnt, track.rate, taken.rate)
    per_frame = ("linear system by EM", "Gaussian process of components", "ridge of components")
    for name in (*per_frame, "nearest stretches") if taken.rate != track.rate else ():
        fillers.pop(name)  # they know one frame rate only
    whole_frames(taken, whole._replace(unseen=[(0, len(values))]), fillers)


def jitter(track: Track) -> None:
    """Print how well noise is taken out."""
    edge = int(SHARE * len(track.values))
    curve = scipy.interpolate.PchipInterpolator(np.arange(len(track.values)), track.values)
    _say("\njitter, learnt from the first 60 %")
    names = ("raw", "10 Hz", "7 Hz", "5 Hz", "linear system", "learnt ratios", "with trust")
    _say(f"{'frames/s':>8}{'noise':>8}" + "".join(f"{name:>15}" for name in names))
    for rate in NOISE_RATES:
        finer = rate / track.rate
        truth = curve(np.arange(int((len(track.values) - 1) * finer) + 1) / finer)
        last = int(edge * finer)
        for noise in NOISES:
            rng = np.random.default_rng(1)
            noisy = truth + noise * rng.standard_normal(truth.shape)
            given, off = noisy[last:], np.zeros(noisy[last:].shape)
            made = [given]
            for cutoff in (10.0, 7.0, 5.0):
                limits = np.full(given.shape[1], cutoff)
                made.append(motion_filter.filtered(given, rate, limits, off))
            made.append(linear_dynamics.smooth(linear_dynamics.learn([noisy[:last]]), given))
            ratios = local_trend.learn([noisy[:last]], [rate])
            made.append(local_trend.smooth(given, rate, ratios, np.ones(given.shape[1])))
            made.append(local_trust.blended(given, made[-1], made[1], off, rate))
            cells = "".join(f"{_rms(one - truth[last:]):15.5f}" for one in made)
            _say(f"{rate:8}{noise:8.3f}{cells}")


def _rms(wrong, axes=None):
    """Return the root mean square over axes; what was not lost does not count."""
    return np.sqrt(np.nanmean(wrong**2, axis=axes))


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
