"""Try every solve where the truth is known in the target: `--data FOLDER`.

`python -m bench.target_trial --data FOLDER`, the folder as in `rig_take`. An actor with 102
markers and 0.3 mm of noise drives a character through key shapes chosen from one part of the take;
its sculpts are the true ones, spoilt. Errors are the mean distance of moving vertices from the
truth [mm] on the other part, the mean of four draws; slopes are solved against true mouth opening
on the widest tenth of frames. `oracle` solves in the target itself, on the spoilt sculpts, by least
squares. `informed` knows the true target of every frame and the kind and size of the spoiling, but
not what it came to: no solve that does not see the character can be better on average.
"""

import argparse
import sys
from collections import defaultdict

import numpy as np

from bench import rig_take
from stages.core import key_shape_candidates, key_weights, pca, successive_projection

CUT = 2600
STEP = 10
NOISE_MM = 0.3
COUNTS, DRAWS, SEED = (12, 21), 4, 1000
SPOILT = [("weight", 0.0), ("weight", 0.15), ("weight", 0.3)] + [
    (kind, size) for kind in ("gain", "bias") for size in (0.15, 0.3)
]
SOLVES = [
    ("least_squares", 0.0, None),
    ("nonnegative_absolute", 0.0, None),
    ("nonnegative_offset", 0.0, None),
    ("simplex", 0.0, None),
    ("tolerant", 0.1, None),
    ("tolerant", 0.15, None),
    ("tolerant", 0.3, None),
    ("tolerant", 0.15, 0.2),
    ("tolerant", 0.15, 0.0),
    ("tolerant_even", 0.1, None),
]
PUBLISHED, DEFAULT = ("least_squares", "nonnegative_absolute"), "tolerant_even 0.1"


def main() -> None:
    """Print errors, slopes and the share of the gap that the default closes, both ways in time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder of the two rigs and the track")
    folder = parser.parse_args().data
    names, track = rig_take.track(folder)
    actor, character = rig_take.actor(folder, names), rig_take.character(folder, names)
    opening = rig_take.opening_of(character, names)
    for title, seen, unseen in (
        ("Key shapes from the first 2,600 frames, measured on the rest", track[:CUT], track[CUT:]),
        ("Key shapes from the last 2,600 frames, measured on the rest", track[-CUT:], track[:-CUT]),
    ):
        errors, slopes = trial(actor, character, opening, seen[::STEP], unseen[::STEP])
        _report(title, errors, slopes)


def trial(actor, character, opening, seen, unseen):
    """Return (count, case, solve) -> list of errors [mm], and likewise of slopes."""
    errors, slopes = defaultdict(list), defaultdict(list)
    markers, vertices = rig_take.deltas_of(actor), rig_take.deltas_of(character)
    neutral = actor.neutral.ravel()
    # its Gram matrix is that of all vertices, so distances in the target are the same
    target = np.linalg.qr(vertices.T)[1].T
    truth = unseen @ opening
    wide = truth >= np.quantile(truth, 0.9)
    for count in COUNTS:
        for draw in range(DRAWS):
            rng = np.random.default_rng(SEED + draw)
            source, frames = (
                neutral + part @ markers + NOISE_MM * rng.standard_normal((len(part), len(neutral)))
                for part in (seen, unseen)
            )
            keys = _key_shapes(source, neutral, count)
            solved = {
                _label(*form): key_weights.solve(frames, source[keys], neutral, *form).weights
                for form in SOLVES
            }
            for kind, size in SPOILT:
                sculpts = _spoilt(seen[keys], target, kind, size, rng)
                solved["oracle"] = _fit(sculpts @ target, unseen @ target)
                solved["informed"] = _informed(seen[keys], target, kind, size, unseen)
                for name, weights in solved.items():
                    made = weights @ sculpts
                    wrong = ((made - unseen) @ vertices).reshape(len(unseen), -1, 3)
                    key = (count, f"{kind} {size:.2f}", name)
                    errors[key].append(np.sqrt(np.sum(wrong**2, axis=2)).mean())
                    slopes[key].append(
                        (made @ opening)[wide] @ truth[wide] / np.sum(truth[wide] ** 2)
                    )
    return errors, slopes


def _key_shapes(frames, neutral, count):
    """Return the frames of the key shapes."""
    candidates = key_shape_candidates.Candidates(
        frames, neutral, pca.fit(frames), np.ones(len(frames), bool)
    )
    return [choice.frame for choice in successive_projection.choose(candidates, count)]


def _spoilt(keys, target, kind, size, rng):
    """Return the sculpts as rows of the track, (K, C)."""
    if kind == "weight":
        return keys * (1 + size * rng.standard_normal(keys.shape))
    if kind == "gain":
        return keys * (1 + size * rng.standard_normal((len(keys), 1)))
    bias = keys.std(axis=0) * rng.standard_normal(keys.shape[1])
    usual = np.linalg.norm(keys @ target, axis=1).mean()
    return keys + bias * size * usual / np.linalg.norm(bias @ target)


def _informed(keys, target, kind, size, unseen):
    """Return the weights of least error expected, given the truth and the kind of spoiling."""
    shapes = keys @ target
    length = np.sum(shapes**2, axis=1)
    if kind == "weight":
        spread = np.diag(size**2 * (keys**2 @ np.sum(target**2, axis=1)))
    elif kind == "gain":
        spread = np.diag(size**2 * length)
    else:
        spread = np.full((len(keys), len(keys)), (size * np.sqrt(length).mean()) ** 2)
    return np.linalg.solve(shapes @ shapes.T + spread, shapes @ (unseen @ target).T).T


def _fit(shapes, frames):
    """Return the least-squares weights (T, K) of shapes for frames."""
    return np.linalg.lstsq(shapes.T, frames.T, rcond=None)[0].T


def _label(method, sigma, bound):
    """Return the name of a solve in the table."""
    label = f"{method} {sigma:g}" if sigma else method
    return label if bound is None else f"{label} within {-bound:g}..{1 + bound:g}"


def _report(title, errors, slopes):
    """Print one row a solve, one column a case, then means and the share of the gap closed."""
    cases = list(dict.fromkeys(key[:2] for key in errors))
    names = list(dict.fromkeys(key[2] for key in errors))
    mean = {key: np.mean(values) for key, values in errors.items()}
    published = [min(mean[*case, name] for name in PUBLISHED) for case in cases]
    oracle = [mean[*case, "oracle"] for case in cases]
    _say(f"\n{title}\n{'':34}" + "".join(f"{f'{k} {case}':>15}" for k, case in cases))
    _say(f"{'':34}" + f"{'error slope':>15}" * len(cases) + "    mean  slope  gap closed")
    for name in names:
        row = [mean[*case, name] for case in cases]
        slope = [np.mean(slopes[*case, name]) for case in cases]
        closed = (np.mean(published) - np.mean(row)) / (np.mean(published) - np.mean(oracle))
        cells = "".join(f"{f'{e:.2f} {s:.2f}':>15}" for e, s in zip(row, slope, strict=True))
        mark = "*" if name == DEFAULT else " "
        _say(f"{name:33}{mark}{cells}{np.mean(row):8.3f}{np.mean(slope):7.3f}{closed:12.2f}")


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main()
