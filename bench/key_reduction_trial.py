"""Compare keys bounded on the mesh with Ramer-Douglas-Peucker on curves: `--data FOLDER` or takes.

`python -m bench.key_reduction_trial --data FOLDER` takes the character and the track of `rig_take`;
`python -m bench.key_reduction_trial results/takes/rom/human ...` takes of the example show. The
curves are reduced within shares of the character's size; then RDP with one tolerance for all
channels, found by bisection, is given the same worst error of a vertex. The time is of one core.
`--large` times a made-up rig of 250 shapes on 4,000 frames, by itself: shapes that reach a
twentieth of 9,000 vertices each, and half of them.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench import rig_take
from stages.core import compose, key_reduction, local_shapes, mesh_error, sculpt_checks
from stages.files import take

SHARES = (0.0005, 0.001, 0.002, 0.005)
STEPS = 14
FARTHER = 1.4
RATE = 60.0
LARGE_SHAPES, LARGE_FRAMES, LARGE_VERTICES, LARGE_SIZE = 250, 4000, 9000, 200.0
REACHES = (500, 4000)


class Case(NamedTuple):
    """Hold curves (T, K), their shapes, the size of the character and the rate."""

    name: str
    values: np.ndarray
    shapes: local_shapes.LocalShapes
    size: float
    rate: float


def main() -> None:
    """Print a row for every case and tolerance."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", help="folder of the two rigs and the track")
    parser.add_argument("--large", action="store_true", help="time the rig of 250 shapes")
    parser.add_argument("takes", nargs="*", type=Path, help="folders results/takes/<shot>/<char>")
    options = parser.parse_args()
    cases = [recorded(options.data, whole) for whole in (False, True)] if options.data else []
    cases += [example(folder) for folder in options.takes]
    _say(f"{'':24}{'share':>8}{'mesh-bounded':>22}{'RDP on curves':>22}{'keys':>7}")
    _say(f"{'':24}{'':>8}{'keys/s':>11}{'worst':>11}{'keys/s':>11}{'worst':>11}{'ratio':>7}    [s]")
    for case in cases:
        for share in SHARES:
            _say(row(case, share))
    for reach in REACHES if options.large else ():
        case = large(reach)
        ours = reduced(case, SHARES[1])
        _say(f"{case.name:24}{SHARES[1]:8.4f}{ours[0]:11.1f}{ours[1]:11.6f}{ours[2]:36.1f}")


def recorded(folder: str, is_whole: bool) -> Case:
    """Return the recorded track on the character, or on all vertices of the actor's rig."""
    names, track = rig_take.track(folder)
    character = (rig_take.whole_actor if is_whole else rig_take.character)(folder, names)
    shapes = local_shapes.gather(character.deltas)
    name = f"recorded, {len(character.neutral)} vert."
    return Case(name, track, shapes, sculpt_checks.diagonal(character.neutral), RATE)


def large(reach: int) -> Case:
    """Return bumps in time on bumps in space, each shape over so many vertices, with noise."""
    rng = np.random.default_rng(0)

    def shape() -> np.ndarray:
        first, moved = rng.integers(0, LARGE_VERTICES - reach), np.zeros((LARGE_VERTICES, 3))
        bump = np.hanning(reach)[:, None] * rng.normal(size=3) * 5 * rng.uniform(0.2, 1)
        moved[first : first + reach] = bump + rng.normal(size=(reach, 3)) * 0.1
        return moved

    shapes = local_shapes.gather(shape() for _ in range(LARGE_SHAPES))
    values, frames = np.zeros((LARGE_FRAMES, LARGE_SHAPES)), np.arange(LARGE_FRAMES)
    for channel in range(LARGE_SHAPES):
        for _ in range(LARGE_FRAMES // 60):
            away = (frames - rng.integers(0, LARGE_FRAMES)) / rng.uniform(3, 20)
            values[:, channel] += rng.uniform(0, 1) * np.exp(-(away**2))
    values += rng.normal(size=values.shape) * 0.003
    return Case(f"250 shapes of {reach} vert.", values, shapes, LARGE_SIZE, RATE)


def example(folder: Path) -> Case:
    """Return a take of the example show."""
    shot, character = folder.parts[-2:]
    rigs = sorted((folder.parents[2] / "cast").glob(f"*/{character}/rig.npz"))
    played = take.read(rigs[0], folder / "weights.parquet")
    size = sculpt_checks.diagonal(played.character.neutral)
    name = f"{shot}/{character}"
    return Case(name, played.motion.weights, played.masked, size, float(played.rate))


def reduced(case: Case, share: float) -> tuple[float, float, float]:
    """Return keys per second, the worst error as a share of the size, and how long it took [s]."""
    begun = time.process_time()
    kept, worst = key_reduction.reduce(case.values, case.shapes, share * case.size)
    passed = time.process_time() - begun
    return kept.sum() * case.rate / len(kept), worst / case.size, passed


def row(case: Case, share: float) -> str:
    """Return a line: keys per second and worst errors as shares of the size."""
    ours, worst, passed = reduced(case, share)
    published, worst_published = on_curves(case, worst * case.size)
    theirs = published.sum() * case.rate / len(published)
    return (
        f"{case.name:24}{share:8.4f}{ours:11.1f}{worst:11.6f}{theirs:11.1f}"
        f"{worst_published / case.size:11.6f}{ours / theirs:7.2f}{passed:7.1f}"
    )


def on_curves(case: Case, most: float) -> tuple[np.ndarray, float]:
    """Return the fewest keys of RDP with a common tolerance within an error, and their error."""
    parts = compose.blocks(case.shapes)

    def kept_within(tolerance: float) -> tuple[np.ndarray, float]:
        kept = key_reduction.thinned(case.values, np.full(case.values.shape[1], tolerance))
        return kept, float(mesh_error.worst(parts, key_reduction.error(case.values, kept))[0].max())

    low, high = 0.0, float(np.ptp(case.values))
    for _ in range(STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if kept_within(middle)[1] <= most else (low, middle)
    # the error may fall again where the tolerance grows
    tried = [kept_within(low * more) for more in np.linspace(1, FARTHER, STEPS)]
    return min((one for one in tried if one[1] <= most), key=lambda one: one[0].sum())


def _say(line: str) -> None:
    """Print a line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
