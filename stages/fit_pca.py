"""Find the principal components of every region over an actor's basis shots (CB02 section 4.2)."""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import pca, region_features
from stages.files import basis, errors, model, regions


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--expressions", required=True, nargs="+", help="basis shots' expressions, .parquet"
    )
    parser.add_argument("--shots", required=True, nargs="+", help="names of these shots")
    parser.add_argument("--regions", required=True, help="table of regions")
    parser.add_argument(
        "--min-confidence",
        required=True,
        type=float,
        help="frames of lower confidence, 0 to 1, are left out",
    )
    parser.add_argument("--pca", required=True, help="axes of every region, .npz")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the basis, fit each region's axes, write them."""
    arguments = build_parser().parse_args(argv)
    frames = basis.read(arguments.expressions, arguments.shots)
    table = regions.read(arguments.regions)
    arrays: dict[str, np.ndarray] = {}
    points: dict[str, list[str]] = {}
    for region in table:
        chosen, weights = regions.select(arguments.regions, table, region, frames.names)
        used = basis.region_confidence(frames, chosen) >= arguments.min_confidence
        if np.count_nonzero(used) < 2:
            message = f"region {region}: {np.count_nonzero(used)} of {len(used)} frames reach"
            cure = "confidence {}: label more frames or lower min_confidence"
            raise errors.InputError(
                arguments.expressions[0], f"{message} {cure.format(arguments.min_confidence)}"
            )
        axes = pca.fit(region_features.stack(frames.points[used][:, chosen], weights))
        arrays |= {
            f"{region}.mean": axes.mean,
            f"{region}.components": axes.components,
            f"{region}.variance": axes.variance,
            f"{region}.explained": pca.explained(axes),
        }
        points[region] = [frames.names[index] for index in chosen]
    meta = {"regions": list(table), "points": points, "units": "face units"}
    meta["coordinates"] = "x and y of each point in turn, times sqrt(weight / sum of weights)"
    model.write(arguments.pca, "pca", arrays, meta, [*arguments.expressions, arguments.regions])


if __name__ == "__main__":
    cli.run_stage(main)
