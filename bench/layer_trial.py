"""Try the layer solver: `python -m bench.layer_trial`, and `--data FOLDER` for a real rig too.

The faces are those of `layer_faces`, at the size of Kholgade 2011: 929 coordinates, 29 + 12 + 3
extremes, three masks. Seconds are of one processor. Objectives are in balanced units, in which the
mean square of an extreme is one. Printed:

- planted: frames drawn from a basis without a shared neutral, noise-free: largest error
- drawn face: a vignette with 0.3 mm of noise and 1 mm of motion that no extreme holds; RMS error of
  what the layers compose to under each mask, residual, objective; the best single layer
- gap: objective less the proven bound, and how often the best of many drawn starts is better
- SLSQP: from the very start and previous state of each frame, on the same Gram matrices with
  analytic gradients; `descent` is the solver from that start alone, `whole` all that it does
- closed lips: the data term gives way to them as a whole, as published, or the mouth's alone
- temporal weight: RMS second difference, blinks' depth left at the frame of the peak, dead layers
- beyond: residual of the vignette played 1.3 times too large
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from bench import layer_faces, layer_rig, layer_scores
from stages.core import layer_model, layer_objective, layer_published, layer_solver

FRAMES, SEED = 900, 5
COMPARED, BRUTE, DRAWS, PUBLISHED = 300, 25, 60, 12
MASKS = ("upper", "mouth", "eyes")


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder of the rig and the recorded track")
    folder = parser.parse_args().data
    _planted()
    face, extra = layer_faces.drawn_face(0)
    performance = layer_faces.performed(face, extra, FRAMES, SEED)
    _trial("drawn face, vignette", face, performance)
    _beyond(face, extra)
    if folder is not None:
        _trial("rig and recorded track", *layer_rig.take(folder))


def _built(face):
    """Return the model of a face."""
    return layer_model.build(
        face.basis,
        face.layer,
        face.masks,
        layer_faces.MOUTH,
        layer_faces.SPEECH,
        layer_faces.CLOSED,
    )


def _solved(model, frames, closeness, temporal, beyond=0.0):
    """Return a solution and the seconds that a frame took."""
    settings = layer_solver.Settings(temporal, beyond)
    layer_solver.solve(model, settings, frames[:2], closeness[:2])
    start = time.process_time()
    solution = layer_solver.solve(model, settings, frames, closeness)
    return solution, (time.process_time() - start) / len(frames)


def _planted() -> None:
    """Print the largest errors on a basis that determines everything."""
    face, _ = layer_faces.drawn_face(1, shared_neutral=False)
    rng = np.random.default_rng(SEED)
    count = 300
    weights = rng.dirichlet(np.ones(3), (count, 3))
    parts = [rng.dirichlet(np.full(size, 0.3), count) for size in layer_faces.COUNTS]
    coefficients = np.concatenate(parts, axis=1)
    frames = layer_faces.composed(face, weights, coefficients)
    solution, taken = _solved(_built(face), frames, np.zeros(count), 0.0)
    _say(f"planted, {count} unrelated frames, condition {np.linalg.cond(face.basis):.0f}")
    _say(f"  largest error of weights {np.abs(solution.weights - weights).max():.1e}")
    _say(
        f"  largest error of coefficients {np.abs(solution.coefficients - coefficients).max():.1e}"
    )
    _say(f"  largest gap {np.max(solution.objective - solution.bound):.1e}, {1e3 * taken:.2f} ms\n")


def _trial(title, face, performance) -> None:
    """Print what can be said of one performance."""
    model = _built(face)
    frames = performance.frames
    open_lips = np.zeros(len(frames))
    _say(f"{title}: {len(frames)} frames, mean energy {np.mean(np.sum(frames**2, axis=1)):.3f}")
    plain, taken = _solved(model, frames, open_lips, 0.0)
    _residuals(face, model, performance, plain)
    _gaps(model, frames, plain)
    _say(f"  plain: {1 / taken:.0f} frames/s")
    _slsqp(model, performance)
    _published(model, performance)
    _smoothing(face, model, performance)
    _lips(face, model, performance)
    _say("")


def _residuals(face, model, performance, plain) -> None:
    """Print errors and residuals of the plain data term, layered and by single layers."""
    if performance.weights is not None:
        exact = layer_faces.composed(face, performance.weights, performance.coefficients)
        errors = layer_scores.mask_errors(face, plain, exact)
        text = ", ".join(f"{name} {e:.2f}" for name, e in zip(MASKS, errors, strict=True))
        _say(f"  RMS error of the composed displacement [mm]: {text}")
    singles = layer_scores.single_residuals(model, performance.frames)
    above = plain.data - singles.min(axis=1)
    parts = ", ".join(f"{mean:.4f}" for mean in singles.mean(axis=0))
    _say(f"  mean data term: layered {plain.data.mean():.4f}; emotion, speech, blink {parts}")
    wrong = performance.frames - layer_faces.composed(face, plain.weights, plain.coefficients)
    _say(f"  RMS residual of the layered one {layer_scores.rms(wrong * face.unit):.3f} mm")
    _say(f"  layered less best single layer: largest {above.max():.1e}")


def _gaps(model, frames, plain) -> None:
    """Print how far the bound is, and whether many starts find anything better."""
    gap = plain.objective - plain.bound
    _say(
        f"  gap: median {np.median(gap):.4f}, mean {gap.mean():.4f}, below 1e-3"
        f" {np.mean(gap < 1e-3):.1%}, below 1e-2 {np.mean(gap < 1e-2):.1%}"
    )
    chosen = np.linspace(1, len(frames) - 1, BRUTE).astype(int)
    better = []
    for index in chosen:
        quadratic = layer_model.project(model, frames[index])
        objective = layer_objective.at(model, quadratic, quadratic, 0.0, 0.0, None)
        best = layer_scores.brute_force(model, objective, DRAWS, int(index))
        better.append(plain.objective[index] - best)
    count, revived = layer_scores.revivable(model, plain, frames, DRAWS)
    _say(f"  frames with a layer of no weight: {count}; many starts better {revived:.0%} of them")
    better = np.array(better)
    _say(
        f"  best of {DRAWS} drawn starts better by 1e-6: {np.mean(better > 1e-6):.0%} of {BRUTE}"
        f" frames, by {max(better.max(), 0.0):.1e} at most"
    )


def _slsqp(model, performance) -> None:
    """Print the comparison with SLSQP."""
    settings = layer_solver.Settings(0.05, 0.0)
    frames = set(np.linspace(1, len(performance.frames) - 1, COMPARED).astype(int).tolist())
    for tolerance in (1e-6, 1e-10):
        got = layer_scores.against_slsqp(model, settings, performance, frames, tolerance)
        _say(f"  SLSQP to {tolerance:g} on {len(got['slsqp'])} frames: ", end="")
        _say(f"{1e3 * got['slsqp s'].mean():.2f} ms a frame, objective {got['slsqp'].mean():.6f}")
        for name in ("descent", "whole"):
            less = got[name] - got["slsqp"]
            ratio = got["slsqp s"].sum() / got[f"{name} s"].sum()
            _say(
                f"    {name}: not worse by 1e-6 on {np.mean(less <= 1e-6):.1%}, mean difference"
                f" {less.mean():+.1e}, {1e3 * got[f'{name} s'].mean():.3f} ms, {ratio:.0f} x faster"
            )


def _published(model, performance) -> None:
    """Print the published sequence on a few frames."""
    part = slice(0, PUBLISHED)
    settings = layer_solver.Settings(0.05, 0.0)
    frames, closeness = performance.frames[part], performance.closeness[part]
    start = time.process_time()
    published = layer_published.solve(model, settings, frames, closeness)
    taken = (time.process_time() - start) / PUBLISHED
    own = layer_solver.solve(model, settings, frames, closeness)
    _say(
        f"  published sequence, first {PUBLISHED} frames: {1e3 * taken:.0f} ms a frame, data term"
        f" {published.data.mean():.4f} against {own.data.mean():.4f}"
    )


def _smoothing(face, model, performance) -> None:
    """Print what the temporal weight costs and gives."""
    truth = performance.blink
    _say("  temporal  jitter mm  blinks left  tenth worst  dead layers  gap < 1e-3  frames/s")
    for temporal in (0.0, 0.05, 0.2):
        got, taken = _solved(model, performance.frames, performance.closeness, temporal)
        shape = layer_faces.composed(face, got.weights, got.coefficients)
        left = layer_scores.peaks_kept(layer_faces.closing(face, shape), truth)
        gap = got.objective - got.bound
        _say(
            f"  {temporal:8.2f}  {layer_scores.jitter(face, got):9.3f}  {left.mean():11.3f}"
            f"  {np.quantile(left, 0.1):11.3f}  {layer_scores.dead(got):11.1%}"
            f"  {np.mean(gap < 1e-3):10.1%}  {1 / taken:8.0f}"
        )


def _lips(face, model, performance) -> None:
    """Print what closed lips cost the rest of the face, as published and not."""
    for bias in ("mouth", "published"):
        residuals, left = layer_scores.closed_lips(model, face, performance, bias)
        text = ", ".join(f"{name} {e:.2f}" for name, e in zip(MASKS, residuals, strict=True))
        mean = f", {len(left)} blinks {left.mean():.2f} left" if len(left) else ""
        _say(f"  closed lips, {bias}: residual [mm] {text}{mean}")


def _beyond(face, extra) -> None:
    """Print the residual of a vignette played too large, with hard and soft bounds."""
    performance = layer_faces.performed(face, extra, FRAMES // 3, SEED + 1, extra_mm=0.3)
    model = _built(face)
    loud = 1.3 * layer_faces.composed(face, performance.weights, performance.coefficients)
    frames = loud + 0.3 * np.random.default_rng(SEED).normal(size=loud.shape) / face.unit
    _say("played 1.3 times too large: mean data term, mean distance outside")
    for beyond in (0.0, 0.25, 0.5):
        got, _ = _solved(model, frames, np.zeros(len(frames)), 0.0, beyond)
        _say(f"  beyond {beyond:.2f}: {got.data.mean():.4f}, {got.outside.mean():.3f}")
    _say("")


def _say(text: str, end: str = "\n") -> None:
    """Print at once."""
    sys.stdout.write(text + end)
    sys.stdout.flush()


if __name__ == "__main__":
    main()
