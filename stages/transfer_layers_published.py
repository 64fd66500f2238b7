"""Find the layers of a take as published: interior point, then sequential quadratic programming.

The same as `transfer_layers` in all but the solver, SciPy's, which starts the first frame at
random, takes some tenths of a second a frame, and gives no lower bound: `gap` is NaN throughout. It
stays within the extremes, so `beyond` must be 0.
"""

import argparse
import functools
from collections.abc import Sequence

from stages import cli, transfer_layers
from stages.core import layer_published
from stages.files import errors


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = transfer_layers.build_parser()
    parser.description = __doc__
    parser.add_argument("--seed", required=True, type=int, help="of the first frame's start")
    return parser


def main(argv: Sequence[str]) -> None:
    """Solve as published."""
    options = build_parser().parse_args(argv)
    if options.beyond != 0:
        message = f"is {options.beyond:g}: the published solver stays within the extremes"
        raise errors.InputError("--beyond", f"{message}, set beyond to 0 in characters.tsv")
    solve = functools.partial(layer_published.solve, seed=options.seed)
    transfer_layers.run(options, "published", solve)


if __name__ == "__main__":
    cli.run_stage(main)
