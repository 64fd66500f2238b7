"""Try how points are balanced on the example's vignette: `python -m bench.layer_balance [show]`.

For each rule and strength of the temporal bias, without the lip bias: what the layers leave of the
points' motion under each mask (1 is standing still), how much of the lids' closing is kept in
blinks, the share of frames whose strongest emotion is the planted one, and jitter, the mean second
difference of what is composed [face units].
"""

import sys
from pathlib import Path

import numpy as np

from stages.core import coordinate_balance, layer_composition, layer_model, layer_solver
from stages.files import layer_points, simplices

SHOT, ACTOR, CHARACTER = "vignette", "mia", "globe"
LIDS = ("RULID", "LULID")
HEIGHT = 1  # the coordinate of a lid that a blink changes
LAMBDAS = (0.0, 0.05, 0.2)
SHUT = 0.5  # planted closure from which a frame belongs to a blink


def table(show: Path) -> list[str]:
    """Return the lines of a table with a row for each rule and strength."""
    made = simplices.read(show / "results/cast" / ACTOR / CHARACTER / "simplices.npz")
    path = show / "results/shots" / SHOT / "expression.parquet"
    points = layer_points.read(path, made.driven_by)
    offsets = layer_points.flat(points, made.layout)
    truth = np.load(show / "data_example/truth" / f"{SHOT}.npz")
    heads = ["rule", "lambda", *made.masks, "blinks", "emotion", "jitter"]
    lines = [f"{heads[0]:14}" + "".join(f"{head:>9}" for head in heads[1:])]
    group = layer_points.group_of(made.layout)
    for rule in coordinate_balance.RULES:
        scale = coordinate_balance.factors(made.basis, group, made.mask_weights, rule)
        model = layer_model.build(made.basis * scale[:, None], made.layer, made.mask_weights)
        for strength in LAMBDAS:
            settings = layer_solver.Settings(
                layer_solver.temporal_at(float(points.rate), strength), 0.0
            )
            solution = layer_solver.solve(model, settings, offsets * scale, np.zeros(len(offsets)))
            u = layer_composition.displacements(
                made.layer, solution.weights, solution.coefficients, solution.amplitudes
            )
            shown = layer_composition.composed(made.basis, made.mask_weights, u)
            cells = [*_left(made, offsets, shown), _blinks(made, offsets, shown, truth)]
            cells += [_emotion(made, solution.coefficients, truth)]
            text = "".join(f"{cell:9.3f}" for cell in (strength, *cells))
            jitter = np.nanmean(np.abs(np.diff(shown, 2, axis=0)))
            lines.append(f"{rule:14}{text}{jitter:9.5f}")
    return lines


def _left(made: simplices.Simplices, offsets: np.ndarray, shown: np.ndarray) -> list[float]:
    """Return the root mean square of what is left under each mask, over that of the motion."""
    return [
        float(
            np.sqrt(np.nanmean((offsets - shown)[:, own] ** 2) / np.nanmean(offsets[:, own] ** 2))
        )
        for own in made.mask_weights > 0.5
    ]


def _blinks(
    made: simplices.Simplices, offsets: np.ndarray, shown: np.ndarray, truth: dict
) -> float:
    """Return the slope of the lids' heights composed against those seen, in blinks."""
    planted = _planted(made, truth, len(offsets))
    shut = planted[:, made.extremes.index(("blink", "closed"))] > SHUT
    names, point_of = layer_points.point_names(made.layout), layer_points.point_of(made.layout)
    found = []
    for lid in LIDS:
        column = int(np.flatnonzero(point_of == names.index(lid))[HEIGHT])
        seen = offsets[:, column] - np.nanmedian(offsets[:, column])
        made_of_it = shown[:, column] - np.nanmedian(shown[:, column])
        use = shut & np.isfinite(seen) & np.isfinite(made_of_it)
        found.append(seen[use] @ made_of_it[use] / (seen[use] @ seen[use]))
    return float(np.mean(found))


def _emotion(made: simplices.Simplices, coefficients: np.ndarray, truth: dict) -> float:
    """Return the share of frames whose strongest emotion is the planted one."""
    own = made.layer == made.layers.index("emotion")
    planted = _planted(made, truth, len(coefficients))[:, own]
    solved = np.isfinite(coefficients[:, own]).all(axis=1)
    same = coefficients[solved][:, own].argmax(axis=1) == planted[solved].argmax(axis=1)
    return float(np.mean(same))


def _planted(made: simplices.Simplices, truth: dict, count: int) -> np.ndarray:
    """Return the planted coefficients (T, K), at the markers' rate."""
    names = list(truth["extreme_names"])
    order = [names.index("_".join(extreme)) for extreme in made.extremes]
    return truth["coefficient"][:count, order].astype(float)


if __name__ == "__main__":
    sys.stdout.write("\n".join(table(Path(sys.argv[1] if len(sys.argv) > 1 else "."))) + "\n")
