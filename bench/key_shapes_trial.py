"""Try every selector of key shapes on a recorded take with known truth: `--data FOLDER`.

`python -m bench.key_shapes_trial --data FOLDER`, the folder as in `rig_take`. Errors are in mm,
root mean square per marker: first on the frames that were chosen from, every tenth of the take;
then with the take cut into 20 blocks of time, each held out once in five turns and the key shapes
chosen from the others; last in the target, the mean distance of the vertices of a character
sculpted without error, on the held-out blocks.
"""

import argparse
import sys

import numpy as np

from bench import rig_take
from stages.core import clustering, key_shape_candidates, key_shape_selection, key_weights, pca

STEP, BLOCKS, TURNS = 10, 20, 5
TRAINED_ON = (6, 8, 12, 16, 24, 30)
HELD_OUT_ON = (8, 12, 16, 24)
BASELINE, NAMED = "maximum_spread", "shared_residual"
PUBLISHED, DEFAULT = "nonnegative_absolute", "tolerant_even"
CENTRES = {"clustering_2d_centres": 2, "clustering_3d_centres": 3}
SIGMA, SEED = 0.1, 1


def main() -> None:
    """Print the three tables and the ratios of the named method to the baseline."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder of the two rigs and the track")
    folder = parser.parse_args().data
    names, track = rig_take.track(folder)
    track = track[::STEP]
    actor, character = rig_take.actor(folder, names), rig_take.character(folder, names)
    _say(f"Chosen from all {len(track)} frames, {PUBLISHED}: training")
    whole = [(track, track)]
    _table(TRAINED_ON, lambda m, k: _mean(actor, whole, m, k, PUBLISHED)[:1])
    turn = np.arange(len(track)) * BLOCKS // len(track) % TURNS
    parts = [(track[turn != number], track[turn == number]) for number in range(TURNS)]
    for solve in (PUBLISHED, DEFAULT):
        _say(f"\nHeld-out blocks of time, {solve}: training, held out, held out in the target")
        cells = _table(HELD_OUT_ON, lambda m, k, s=solve: _mean(actor, parts, m, k, s, character))
        for column, place in ((1, "held out"), (2, "in the target")):
            ratios = [cells[NAMED, k][column] / cells[BASELINE, k][column] for k in HELD_OUT_ON]
            text = " ".join(f"{ratio:.2f}" for ratio in ratios)
            _say(f"{NAMED} / {BASELINE}, {place}: {text}")


def _mean(actor, parts, method, count, solve, character=None):
    """Return the errors of all turns together [mm]: training, held out and in the target."""
    found = [_errors(actor, *part, method, count, solve, character) for part in parts]
    seen, unseen, target = (np.concatenate(row) for row in zip(*found, strict=True))
    means = [float(np.sqrt(np.mean(squares))) for squares in (seen, unseen)]
    return [*means, float(np.mean(target))] if len(target) else means


def _errors(actor, seen, unseen, method, count, solve, character):
    """Return squared errors of the seen and the unseen frames, and distances in the target."""
    markers = len(actor.neutral)
    offsets = rig_take.deltas_of(actor) / np.sqrt(markers)
    neutral = actor.neutral.ravel() / np.sqrt(markers)
    mix = _choose(seen @ offsets, neutral, method, count) @ seen
    shapes = neutral + mix @ offsets
    squares = []
    for part in (seen, unseen):
        frames = neutral + part @ offsets
        solution = key_weights.solve(frames, shapes, neutral, solve, SIGMA)
        made = neutral + solution.weights @ (shapes - neutral)
        if solve == PUBLISHED:
            # equation 5 as published: without the share of the neutral that the bake adds
            made = solution.weights @ shapes
        squares.append(np.sum((frames - made) ** 2, axis=1))
    if character is None:
        return [*squares, np.zeros(0)]
    wrong = (solution.weights @ mix - unseen) @ rig_take.deltas_of(character)
    distances = np.linalg.norm(wrong.reshape(len(unseen), -1, 3), axis=2)
    return [*squares, distances.mean(axis=1)]


def _choose(offsets, neutral, method, count):
    """Return the key shapes as mixtures (K, T) of the frames: a cluster's centre is one."""
    frames = neutral + offsets
    candidates = key_shape_candidates.Candidates(
        frames, neutral, pca.fit(frames), np.ones(len(frames), bool), seed=SEED, sigma=SIGMA
    )
    if method in CENTRES:
        return clustering.memberships(candidates, count, CENTRES[method])
    choices = key_shape_selection.choose(candidates, count, method)
    return np.eye(len(frames))[[choice.frame for choice in choices]]


def _table(counts, errors_of):
    """Print and return the errors of every method and count."""
    cells = {}
    _say(f"{'method':24}" + "".join(f"{count:>18}" for count in counts))
    for method in (*key_shape_selection.SELECTORS, *CENTRES):
        row = f"{method:24}"
        for count in counts if method != key_shape_selection.FIXED_BY_DATA else counts[:1]:
            cells[method, count] = errors_of(method, count)
            row += f"{' '.join(f'{error:.2f}' for error in cells[method, count]):>18}"
        _say(row)
    return cells


def _ratios(cells, column):
    """Print the named method's error over the baseline's at every count."""
    ratios = [cells[NAMED, k][column] / cells[BASELINE, k][column] for k in HELD_OUT_ON]
    _say(f"{NAMED} / {BASELINE}: " + " ".join(f"{ratio:.2f}" for ratio in ratios))


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main()
