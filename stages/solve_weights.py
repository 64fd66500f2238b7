"""Solve the weights of the key shapes on every frame of a shot, per region (CB02 section 4.1).

A frame on which some points of a region were not observed is solved on the others, if these hold
half of the region's weight; else its weights are NaN.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import key_weights, region_features
from stages.files import errors, key_shapes, region_settings, regions, series

ENOUGH = 0.5


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--expression", required=True, help="the shot's expression, .parquet")
    parser.add_argument("--key-shapes", required=True, help="the actor's key shapes, .parquet")
    parser.add_argument("--regions", required=True, help="table of regions")
    parser.add_argument("--region-settings", required=True, help="table of their settings")
    parser.add_argument("--key-weights", required=True, help="weights to write, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read expression and key shapes, solve each region, write the weights."""
    arguments = build_parser().parse_args(argv)
    expression = series.read(arguments.expression, "expression")
    shapes = key_shapes.read(arguments.key_shapes)
    table = regions.read(arguments.regions)
    settings = region_settings.read(arguments.region_settings, table)
    columns: dict[str, np.ndarray] = {}
    for region in table:
        own = [shape for shape in shapes if shape.region == region]
        solution = _solve(arguments, expression, table, region, own, settings[region])
        for shape, weights in zip(own, solution.weights.T, strict=True):
            columns[f"{region}.{shape.key_shape}"] = weights
        columns[f"{region}.residual"] = solution.residual
        columns[f"{region}.kkt_residual"] = solution.kkt_residual
    columns["confidence"] = expression.columns["confidence"]
    series.write(
        arguments.key_weights,
        "key_weights",
        expression.frame,
        expression.time_s,
        columns,
        expression.rate,
        {"residual_unit": "face units", "solves": {r: settings[r].solve for r in table}},
        [arguments.expression, arguments.key_shapes],
    )


def _solve(
    arguments: argparse.Namespace,
    expression: series.Series,
    table: regions.Regions,
    region: str,
    own: Sequence[key_shapes.KeyShape],
    setting: region_settings.Settings,
) -> key_weights.Solution:
    """Solve one region, together the frames on which the same points were observed."""
    names = expression.meta["points"]
    chosen, weights = regions.select(arguments.regions, table, region, names)
    if [names[index] for index in chosen] != key_shapes.read_points(arguments.key_shapes)[region]:
        message = f"the key shapes of region {region} have other points than the expression"
        raise errors.InputError(arguments.key_shapes, message + ": run select_key_shapes again")
    points = series.stack(expression, arguments.expression, names)[:, chosen]
    neutral = np.array(expression.meta["neutral"], float)[chosen]
    corners = np.array([shape.shape for shape in own]).reshape(len(own), *neutral.shape)
    observed = np.isfinite(points).all(axis=2)
    solved = np.full((len(points), len(own) + 2), np.nan)
    for pattern in np.unique(observed, axis=0):
        if weights[pattern].sum() < ENOUGH * weights.sum():
            continue
        rows = (observed == pattern).all(axis=1)
        features = [
            region_features.stack(array[..., pattern, :], weights[pattern])
            for array in (points[rows], corners, neutral)
        ]
        solution = key_weights.solve(*features, setting.solve, setting.sigma, setting.bound)
        solved[rows] = np.column_stack(solution)
    return key_weights.Solution(solved[:, :-2], solved[:, -2], solved[:, -1])


if __name__ == "__main__":
    cli.run_stage(main)
