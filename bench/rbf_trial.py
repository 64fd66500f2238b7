"""Try the regressions from tuned pairs where the truth is known in the target: `--data FOLDER`.

`python -m bench.rbf_trial --data FOLDER`, the folder as in `rig_take`. An actor with 102 markers
and 0.3 mm of noise drives a character. 100 pairs are chosen by farthest point in 2,400 frames of
the take and tuned with an error of 0.03 on every weight; every fifth of the 1,430 frames at its
other end is scored: mean distance of moving vertices from the truth [mm], the mean of five draws,
then the least and the largest ratio to the plain ridge in one draw. All is tried both ways in time.
What is cross-validated sees the pairs alone.

The first actor is linear, so that a ridge is its right model; the second is `nonlinear_actor`, the
third is the same with half of its correctives. The blendshape equation has its virtual markers from
`picked_places`.

Then the rank of a pair whose weights were replaced by those of another, and the time of a rig of
946 shapes over 36,000 frames.
"""

import argparse
import resource
import sys
import time
from collections import defaultdict

import numpy as np

from bench import nonlinear_actor, picked_places, rig_take
from stages.core import (
    equation,
    pair_contradictions,
    partial_projection,
    pca,
    regression_choice,
    weight_regression,
)

SEEN, SCORED, STEP = 2400, 1430, 5
NOISE_MM, TUNING, PAIRS = 0.3, 0.03, 100
DRAWS, SEED = 5, 500
PLANTED, UNLIKE = 40, 0.15
PUBLISHED = 4
RIDGE = "linear ridge, 25 dimensions"
METHODS = {
    "rbf as published, 4 dimensions": ("rbf", PUBLISHED, True),
    "rbf, 2 dimensions": ("rbf", 2, True),
    "rbf, 8 dimensions": ("rbf", 8, True),
    "rbf, 15 dimensions": ("rbf", 15, True),
    "rbf, 25 dimensions": ("rbf", 25, True),
    "rbf, dimensions cross-validated": ("rbf", None, True),
    "rbf, 4 dimensions, width cross-validated": ("rbf", PUBLISHED, False),
    "rbf, both cross-validated": ("rbf", None, False),
    "rbf_linear, cross-validated": ("rbf_linear", None, False),
    RIDGE: ("linear", 25, False),
    "linear ridge, cross-validated": ("linear", None, False),
}
EQUATIONS = ("positions", "displacements", "bounded")


def main() -> None:
    """Print a table for each actor, the ranks and the times."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder of the two rigs and the track")
    folder = parser.parse_args().data
    names, track = rig_take.track(folder)
    rig, character = rig_take.actor(folder, names), rig_take.character(folder, names)
    vertices = rig_take.deltas_of(character)
    places = picked_places.pick(folder, names)
    straight = rig.neutral + np.tensordot(track, rig.deltas, 1)
    bent = {s: nonlinear_actor.make(rig, names, s) for s in (nonlinear_actor.STRENGTH, 0.4)}
    actors = {"linear actor": straight} | {
        f"non-linear actor, correctives {strength:g}: no linear map of its weights explains"
        f" {nonlinear_actor.nonlinearity(actor, track):.1%}"
        " of its motion": nonlinear_actor.move(actor, track)
        for strength, actor in bent.items()
    }
    for title, moved in actors.items():
        for way, order in (("first", slice(None)), ("last", slice(None, None, -1))):
            errors, forms = trial(moved[order], track[order], vertices, rig.neutral, places)
            _report(f"{title}; pairs from the {way} {SEEN} frames", errors, forms)
    _say(f"\nA planted pair among {PAIRS} is ranked first: {_ranked_first(straight, track)}")
    _times()


def trial(moved, track, vertices, neutral, places):
    """Return method -> errors of the draws [mm], and method -> forms that were chosen."""
    errors, forms = defaultdict(list), defaultdict(list)
    truth = track[-SCORED::STEP]

    def score(name, weights):
        wrong = ((weights - truth) @ vertices).reshape(len(truth), -1, 3)
        errors[name].append(np.linalg.norm(wrong, axis=2).mean())

    for draw in range(DRAWS):
        examples, targets, frames, points = _drawn(moved, track, SEED + draw)
        score("standing still", np.zeros_like(truth))
        for name in EQUATIONS:
            found = equation.solve(points, neutral, places.neutral, places.deltas, name)
            score(f"blendshape equation, {name}", found.weights)
        for name, settings in METHODS.items():
            form = regression_choice.choose(examples, targets, *settings)
            trained, _ = weight_regression.train(examples, targets, form)
            score(name, np.clip(weight_regression.predict(trained, frames), 0.0, 1.0))
            forms[name].append(form)
    return errors, forms


def _drawn(moved, track, seed):
    """Return examples and their tuned weights, scored frames on the axes, and as points."""
    rng = np.random.default_rng(seed)
    noisy = moved + NOISE_MM * rng.standard_normal(moved.shape)
    flat = noisy.reshape(len(noisy), -1)
    chosen = _farthest(flat[:SEEN])
    targets = track[chosen] + TUNING * rng.standard_normal((PAIRS, track.shape[1]))
    axes, noise = partial_projection.truncate(pca.fit(flat[:SEEN]), regression_choice.MOST)
    examples, frames = (
        partial_projection.project(axes, noise, part)
        for part in (flat[chosen], flat[-SCORED::STEP])
    )
    return examples, np.clip(targets, 0.0, 1.0), frames, noisy[-SCORED::STEP]


def _farthest(frames):
    """Return rows chosen by farthest point, from the first frame on."""
    chosen = [0]
    distance = np.linalg.norm(frames - frames[0], axis=1)
    while len(chosen) < PAIRS:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(frames - frames[chosen[-1]], axis=1))
    return chosen


def _ranked_first(moved, track):
    """Return how often a planted contradiction comes first, and its mean rank, as text."""
    rng = np.random.default_rng(SEED)
    examples, targets, _, _ = _drawn(moved, track, SEED)
    form = regression_choice.choose(examples, targets, "rbf_linear")
    ranks = []
    while len(ranks) < PLANTED:
        spoilt, other = rng.choice(PAIRS, 2, replace=False)
        planted = targets.copy()
        planted[spoilt] = targets[other]
        if np.sqrt(np.mean((planted - targets)[spoilt] ** 2)) < UNLIKE:
            continue
        trained, residuals = weight_regression.train(examples, planted, form)
        misfits = planted - weight_regression.predict(trained, examples)
        doubt = pair_contradictions.doubt(residuals, misfits)
        ranks.append(int(np.sum(doubt > doubt[spoilt])) + 1)
    return f"{ranks.count(1)} of {PLANTED}, worst rank {max(ranks)}"


def _times():
    """Print how long choosing, training and predicting take for a large rig."""
    rng = np.random.default_rng(SEED)
    frames = rng.standard_normal((36_000, 20)) @ rng.standard_normal((20, 306))
    axes, noise = partial_projection.truncate(pca.fit(frames), regression_choice.MOST)
    examples = partial_projection.project(axes, noise, frames[:PAIRS])
    targets = rng.uniform(size=(PAIRS, 946)) * (rng.uniform(size=(PAIRS, 946)) < 0.1)
    for method in weight_regression.METHODS:
        start = time.process_time()
        form = regression_choice.choose(examples, targets, method)
        trained, _ = weight_regression.train(examples, targets, form)
        learnt = time.process_time()
        for first in range(0, len(frames), 2048):
            at = partial_projection.project(axes, noise, frames[first : first + 2048])
            weight_regression.predict(trained, at)
        done = time.process_time()
        text = f"learnt in {learnt - start:.1f} s, 36,000 frames in {done - learnt:.2f} s"
        _say(f"{method}, 946 shapes, 306 coordinates, {PAIRS} pairs: {text} of one processor")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    _say(f"largest memory of this whole run: {peak:.0f} MB")


def _report(title, errors, forms):
    """Print the error of every method and what was chosen in the first draw."""
    _say(
        f"\n{title}\n{'':42}{'mm':>7}{'/ridge':>9}{'least':>7}{'most':>7}  chosen in the first draw"
    )
    base = np.array(errors[RIDGE])
    for name, values in errors.items():
        ratio = np.array(values) / base
        cells = f"{np.mean(values):7.3f}{np.mean(values) / base.mean():9.2f}"
        row = f"{name:42}{cells}{ratio.min():7.2f}{ratio.max():7.2f}"
        _say(f"{row}  {_described(forms[name][0])}" if name in forms else row)


def _described(form):
    """Return a form in words."""
    parts = [f"linear in {form.linear_dimensions}"] if form.linear_dimensions else []
    if form.rbf_dimensions:
        parts.append(f"Gaussians in {form.rbf_dimensions}, width {form.factor:.2g}")
    return ", ".join(parts) + (f", share {form.share:g}" if form.share else "")


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
