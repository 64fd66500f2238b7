"""Learn how an actor moves a character's shapes, from weights that were solved for basis takes.

What lies between two poses, how channels move together, and how fast each moves against its
jitter: `smooth_weights` fills gaps of lost tracking and takes jitter out with it. Takes may have
different frame rates. Frames without confidence are not learnt from.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import between_poses, local_trend
from stages.files import dynamics, errors, rig, series, solutions


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    kinds = ", ".join(solutions.LIMITS)
    parser.add_argument(
        "--solutions", required=True, nargs="+", help=f"basis takes, .parquet: {kinds}"
    )
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--dynamics", required=True, help="what was learnt, .npz, to write")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the takes, learn, write."""
    options = build_parser().parse_args(argv)
    shapes = rig.read_any(options.rig).names
    takes, rates, used = [], [], []
    for path in options.solutions:
        solved = series.read(path, tuple(solutions.LIMITS))
        values = solutions.observed(solved, path, shapes)
        unseen = np.flatnonzero(~np.isfinite(values).any(axis=0))
        if len(unseen):
            cli.logger.info("left out, %s is nowhere tracked: %s", shapes[unseen[0]], path)
            continue
        takes.append(values)
        rates.append(float(solved.rate))
        used.append(path)
    if not takes:
        message = "in no basis take is every shape tracked somewhere: see the shots' confidence"
        raise errors.InputError(options.solutions[0], message)
    try:
        motion = between_poses.learn(takes, rates)
    except ValueError as error:
        message = f"{error}: mark longer shots as basis, or do without dynamics"
        raise errors.InputError(options.solutions[0], message) from error
    whole = [
        between_poses.fill(motion, take, rate) for take, rate in zip(takes, rates, strict=True)
    ]
    learnt = dynamics.Dynamics(shapes, motion, local_trend.learn(whole, rates))
    dynamics.write(options.dynamics, learnt, [*used, options.rig])
    cli.logger.info("%d takes, gaps of up to %.2f s", len(takes), motion.durations[-1])


if __name__ == "__main__":
    cli.run_stage(main)
