"""Find how much of each extreme of emotion, speech and blink a take shows (K11 section 4).

The coefficients of a layer and the weights of a mask sum to one; with `beyond` above 0 each mask
has an amplitude too, so that a smile stays in a mouth that speaks. While the actor's lips are
closed the gap of the character's is one more row of data; or, as published, its lips' mask is drawn
to speech and speech to its m. Where the lips' distance was not observed, or `lip_sigma` is 0, it
says nothing. Save as published, all points about the lips tell it, not the two alone. Each frame is
drawn to the one before by `temporal`, which is brought to the take's rate. Frames with less than
half of the coordinates have no layers, and confidence 0; frames after them start from the last that
has.
"""

import argparse
from collections.abc import Callable, Sequence

import numpy as np

from stages import cli
from stages.core import (
    layer_composition,
    layer_model,
    layer_solver,
    lip_closeness,
    lip_estimate,
)
from stages.files import errors, extremes, layer_points, layers, lip_gap, simplices

CHUNK = 1024
# beyond this a frame is that before, or a bound none, to every digit
MOST = 1e6
Solve = Callable[
    [layer_model.Model, layer_solver.Settings, np.ndarray, np.ndarray], layer_solver.Solution
]


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--simplices", required=True, help="what is shared, simplices.npz")
    parser.add_argument("--expression", required=True, help="the shot's expression, .parquet")
    parser.add_argument(
        "--lip-points", required=True, help="upper,lower: points that show lip closures, or empty"
    )
    parser.add_argument("--lip-mask", required=True, help="the mask of the lips")
    for name, text in (
        ("lip-sigma", "distance at which lips still count as closing [face units]; 0 for no bias"),
        ("temporal", "how strongly a frame clings to the one before, at 30 frames/s"),
        (
            "beyond",
            "how far a mask's layers may together exceed one, 0.5 up to 1.5 times; 0 not at all",
        ),
        ("lean", "how strongly a mask is left to the layers that move what is under it; 0 not"),
    ):
        parser.add_argument(f"--{name}", required=True, type=float, help=text)
    parser.add_argument(
        "--lip-bias",
        required=True,
        choices=layer_solver.LIP_BIASES,
        help="what closed lips do: keep the character's lips closed; draw the mouth to speech m;"
        " or that while the whole face gives way, as published",
    )
    parser.add_argument("--layers", required=True, help="layers to write, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Solve with the certified solver."""
    run(build_parser().parse_args(argv), "certified", _solve)


def run(options: argparse.Namespace, solver: str, solve: Solve) -> None:
    """Read simplices and points, solve every frame, write the layers.

    Parameters
    ----------
    options : of `build_parser`
    solver : its name, for the file
    solve : model, settings, frames (T, D) and closeness (T,) to the solution of all frames
    """
    for name in ("lip_sigma", "temporal", "beyond", "lean"):
        if not 0 <= getattr(options, name) <= MOST:
            flag = f"--{name.replace('_', '-')}"
            raise errors.InputError(flag, f"is {getattr(options, name):g}: give 0 to {MOST:g}")
    made = simplices.read(options.simplices)
    points = layer_points.read(options.expression, made.driven_by)
    if missing := layer_points.check_within(options.expression, points, made.layout):
        cli.logger.info("not used, the shot lacks them: %s", ", ".join(missing))
    offsets = layer_points.flat(points, made.layout)
    closeness = _closeness(options, made, points.frame, offsets * made.scale)
    lips = simplices.lip_indices(made) if closeness.any() else (-1, -1, -1)
    gaps = made.gaps if closeness.any() else None
    model = layer_model.build(
        made.basis * made.scale[:, None], made.layer, made.mask_weights, *lips, gaps
    )
    temporal = layer_solver.temporal_at(float(points.rate), options.temporal)
    settings = layer_solver.Settings(temporal, options.beyond, options.lip_bias, options.lean)
    solution = solve(model, settings, offsets * made.scale, closeness)
    measures = {
        "residual": _residual(made, solution, offsets),
        "outside": solution.outside,
        "objective": solution.objective,
        "gap": np.where(np.isfinite(solution.bound), solution.objective - solution.bound, np.nan),
        "lip_bias": closeness,
    }
    solved = np.isfinite(solution.objective)
    layers.write(
        options.layers,
        layers.Layers(
            points.frame,
            points.time_s,
            points.rate,
            made.masks,
            made.layers,
            made.extremes,
            solution.weights,
            solution.coefficients,
            solution.amplitudes,
            measures,
            np.where(solved, points.confidence, 0.0),
        ),
        {"solver": solver},
        [options.simplices, options.expression],
    )


def _closeness(
    options: argparse.Namespace, made: simplices.Simplices, frame: np.ndarray, offsets: np.ndarray
) -> np.ndarray:
    """Return how nearly closed the lips are on every frame (T,), by balanced offsets (T, D)."""
    if options.lip_sigma == 0 or extremes.CLOSED_LIPS[0] not in made.layers:
        return np.zeros(len(frame))
    simplices.check_lips(options.simplices, made, options.lip_points, options.lip_mask)
    gap = lip_gap.read(options.expression, options.lip_points, frame)
    if options.lip_bias != "published" and made.gap_weights.any():
        told = lip_estimate.Estimate(made.gap_weights, made.gap_start)
        estimated = lip_estimate.gap(told, offsets) + made.closed_gap
        gap = np.where(np.isnan(estimated), gap, estimated)
    rule = lip_closeness.steep if options.lip_bias == "gap" else lip_closeness.closeness
    return rule(gap, made.closed_gap, options.lip_sigma)


def _solve(
    model: layer_model.Model,
    settings: layer_solver.Settings,
    frames: np.ndarray,
    closeness: np.ndarray,
) -> layer_solver.Solution:
    """Solve frame after frame, showing how far it has come."""
    progress = cli.Progress("solving layers, frames", len(frames))
    solutions, state = [], None
    for frame, near in zip(frames, closeness, strict=True):
        solution, state = layer_solver.solve_frame(model, settings, frame, float(near), state)
        solutions.append(solution)
        progress.step()
    return layer_solver.stacked(solutions)


def _residual(
    made: simplices.Simplices, solution: layer_solver.Solution, offsets: np.ndarray
) -> np.ndarray:
    """Return the root mean square (T,) of what is left of the observed coordinates."""
    left = np.full(len(offsets), np.nan)
    for start in range(0, len(offsets), CHUNK):
        rows = start + np.flatnonzero(np.isfinite(solution.objective[start : start + CHUNK]))
        u = layer_composition.displacements(
            made.layer,
            solution.weights[rows],
            solution.coefficients[rows],
            solution.amplitudes[rows],
        )
        shown = layer_composition.composed(made.basis, made.mask_weights, u)
        left[rows] = np.sqrt(np.nanmean((offsets[rows] - shown) ** 2, axis=1))
    return left


if __name__ == "__main__":
    cli.run_stage(main)
