"""Try the blendshape equation where the truth is known: `--data FOLDER`, as in `rig_take`.

First an actor and a character of other form (trial D): 102 markers with 0.3 mm of noise, virtual
markers picked by `picked_places`, scored on every fifth of the last 1,430 frames as the mean
distance of moving vertices from the truth [mm]. `rest` is a character that stands still.

Then noise alone: the markers lie on the character itself, and the weights that come back are
compared with those that moved it, all of the last 1,430 frames at 30 a second. Blink peaks kept are
solved against true weights at the peaks of the two lids, each at its best frame of three.
"""

import argparse
import sys

import numpy as np

from bench import picked_places, rig_take
from stages.core import equation

UNSEEN, STEP, RATE = 1430, 5, 30.0
SEEDS = (0, 1, 2, 3)
NOISE_MM, NOISES_MM = 0.3, (0.3, 1.0)
AVERAGES, STRENGTHS = (3, 5, 9), (0.3, 1.0, 3.0, 10.0, 30.0)
LIDS = ("eyeBlinkLeft", "eyeBlinkRight")
BLINK, AROUND = 0.3, 6


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder of the two rigs and the track")
    folder = parser.parse_args().data
    names, track = rig_take.track(folder)
    truth = track[-UNSEEN:]
    character = rig_take.character(folder, names)
    _unlike(folder, names, truth, character)
    for noise in NOISES_MM:
        _noisy(names, truth, character, picked_places.pick(folder, names), noise)


def _unlike(folder, names, truth, character):
    """Print the error on a character of another form."""
    actor = rig_take.actor(folder, names)
    _say("An actor and a character of other form, error [mm]\n")
    _say(f"{'':24}{'picked':>10}{'by scale':>10}")
    rows = {"rest": [_error(character, 0 * truth, truth)] * 2}
    for bent in (True, False):
        places = picked_places.pick(folder, names, bent)
        for method in equation.METHODS:
            found = [
                _error(character, _solved(actor, places, truth, method, NOISE_MM, seed), truth)
                for seed in SEEDS
            ]
            rows.setdefault(method, []).append(np.mean(found))
    for name, errors in rows.items():
        _say(f"{name:24}" + "".join(f"{error:10.2f}" for error in errors))


def _noisy(names, truth, character, places, noise):
    """Print how well weights come back from markers on the character itself."""
    lids = [names.index(lid) for lid in LIDS]
    single = {
        method: _solved(places, places, truth, method, noise, 0)
        for method in ("displacements", "bounded")
    }
    rows = dict(single)
    for method, weights in single.items():
        for width in AVERAGES:
            rows[f"{method}, mean of {width}"] = np.clip(_averaged(weights, width), 0, 1)
    for strength in STRENGTHS:
        for name, share in (("common", 1.0), ("weak on blinks", equation.BLINK_STRENGTH)):
            each = np.full(len(names), strength)
            each[lids] *= share
            rows[f"clip {strength:g}, {name}"] = _solved(
                places, places, truth, "clip", noise, 0, each
            )
    _say(f"\nNoise alone, {noise:g} mm\n\n{'':28}{'weight RMSE':>12}{'blinks kept':>12}{'mm':>8}")
    moves = np.abs(places.deltas).max(axis=(1, 2)) > 0
    for name, weights in rows.items():
        rms = np.sqrt(np.mean((weights - truth)[:, moves] ** 2))
        kept = _kept(weights, truth, lids)
        _say(f"{name:28}{rms:12.4f}{kept:12.1%}{_error(character, weights, truth):8.3f}")


def _solved(actor, places, truth, method, noise, seed, strength=1.0):
    """Return the weights (T, C) solved from an actor's markers."""
    moved = actor.neutral + np.tensordot(truth, actor.deltas, axes=1)
    moved += noise * np.random.default_rng(seed).standard_normal(moved.shape)
    return equation.solve(
        moved,
        actor.neutral,
        places.neutral,
        places.deltas,
        method,
        strength=strength,
        rate=RATE,
    ).weights


def _error(character, weights, truth):
    """Return the mean distance of vertices from the truth on every fifth frame [mm]."""
    wrong = (weights - truth)[::STEP] @ rig_take.deltas_of(character)
    return np.linalg.norm(wrong.reshape(len(wrong), -1, 3), axis=2).mean()


def _averaged(weights, width):
    """Return the moving average of weights (T, C), ends repeated."""
    padded = np.pad(weights, ((width // 2, width // 2), (0, 0)), mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, width, axis=0).mean(axis=2)


def _kept(weights, truth, lids):
    """Return solved against true weights at the peaks of blinks."""
    ratios = []
    for lid in lids:
        curve = truth[:, lid]
        for frame in range(AROUND, len(curve) - AROUND):
            near = curve[frame - AROUND : frame + AROUND + 1]
            base = max(near[:AROUND].min(), near[AROUND:].min())
            if curve[frame] == near.max() and curve[frame] - base > BLINK:
                ratios.append(weights[frame - 1 : frame + 2, lid].max() / curve[frame])
    return np.mean(ratios)


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main()
