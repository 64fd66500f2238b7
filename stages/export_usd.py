"""Write a take as USD: blend shapes with a head joint, and points at every frame."""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.files import atomic, take, usd_points, usd_skel


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument("--usd", required=True, help="mesh.usdc to write: UsdSkel blend shapes")
    parser.add_argument("--points", required=True, help="points.usdc to write: point samples")
    return parser


def main(argv: Sequence[str]) -> None:
    """Write the points frame by frame, then the blend shapes."""
    options = build_parser().parse_args(argv)
    played = take.read(options.rig, options.weights)
    progress = cli.Progress("export", len(played.frame))
    boxes = []
    with atomic.replacing(options.points) as points, atomic.replacing(options.usd) as shapes:
        clock = played.frame, played.rate, played.start
        with usd_points.writer(points, played.character, *clock) as append:
            for positions in take.positions(played, options.weights):
                append(positions)
                boxes.append([positions.min(axis=0), positions.max(axis=0)])
                progress.step()
        boxes = np.array(boxes, float)
        usd_skel.write(shapes, played.character, played.masked, played.motion, boxes, *clock)


if __name__ == "__main__":
    cli.run_stage(main)
