"""Predict the weights of a rig on every frame of a shot from what `train_rbf` learnt.

Points that are missing on a frame are filled with the likeliest by the principal axes; where half
of the values are missing the weights are NaN, and the confidence is 0. Weights stay within the
limits of the channels. `distance` is how far a frame lies from the nearest example, in median
distances of an example from its nearest neighbour: well above 1, nobody showed what to do there.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import partial_projection, rbf, weight_regression
from stages.files import actor_points, channels, driving_points, errors, rbf_model, rig, series

CHUNK = 2048


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rbf", required=True, help="what train_rbf learnt, .npz")
    parser.add_argument("--expression", required=True, help="the shot's expression, .parquet")
    parser.add_argument(
        "--points", required=True, choices=list(driving_points.AXES), help="which of its points"
    )
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--channels", required=True, help="table of the channels, or ''")
    parser.add_argument("--predicted", required=True, help="weights to write, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read points and regression, predict in parts, write the weights."""
    options = build_parser().parse_args(argv)
    learnt = rbf_model.read(options.rbf)
    driving = driving_points.read(options.expression, options.points)
    shapes = rig.read_any(options.rig).names
    if learnt.shapes != shapes or learnt.points != options.points:
        message = f"was trained for {learnt.points} points and {len(learnt.shapes)} shapes"
        wanted = f"not for {options.points} and the {len(shapes)} of {options.rig}"
        raise errors.InputError(options.rbf, f"{message}, {wanted}: run train_rbf again")
    unknown = [name for name in learnt.point_names if name not in driving.names]
    if 2 * len(unknown) > len(learnt.point_names):
        message = f"{len(unknown)} of the {len(learnt.point_names)} points of {options.rbf}"
        cure = "name them as in the basis shots"
        raise errors.InputError(
            options.expression, f"{message} are missing, the first is {unknown[0]}: {cure}"
        )
    if unknown:
        cli.logger.info("estimated, the shot lacks them: %s", ", ".join(unknown))
    limits = channels.read(options.channels, shapes, 0.0, 1.0)
    weights, distance, observed = _predict(learnt, driving, limits)
    columns = dict(zip(shapes, weights, strict=True))
    columns |= {"distance": distance, "confidence": np.where(observed, driving.confidence, 0.0)}
    meta = {"distance_unit": "median distance of neighbouring examples"}
    sources = [options.rbf, options.expression, options.rig]
    sources += [options.channels] if options.channels else []
    series.write(
        options.predicted,
        "predicted",
        driving.frame,
        driving.time_s,
        columns,
        driving.rate,
        meta,
        sources,
    )


def _predict(
    learnt: rbf_model.RbfModel,
    driving: driving_points.DrivingPoints,
    limits: channels.Channels,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return weights (K, T), distance (T,) and whether enough was observed (T,)."""
    offsets = actor_points.offsets_of(driving, learnt.point_names)
    observed = actor_points.observed_share(offsets) >= actor_points.ENOUGH
    weights = np.full((len(learnt.shapes), len(offsets)), np.nan, np.float32)
    distance = np.full(len(offsets), np.nan)
    progress = cli.Progress("predicting, parts of 2,048 frames", -(-len(offsets) // CHUNK))
    for start in range(0, len(offsets), CHUNK):
        rows = start + np.flatnonzero(observed[start : start + CHUNK])
        at = partial_projection.project(learnt.axes, learnt.noise, offsets[rows])
        found = weight_regression.predict(learnt.regression, at)
        weights[:, rows] = np.clip(found, limits.low, limits.high).T
        seen = at[:, : learnt.examples.shape[1]]
        nearest = rbf.squared_distances(seen, learnt.examples).min(axis=1)
        distance[rows] = np.sqrt(nearest) / learnt.spacing
        progress.step()
    return weights, distance, observed


if __name__ == "__main__":
    cli.run_stage(main)
