"""Bake a take of a character whose poses are tables of controls: one curve for each control.

Head motion is no part of the curves: it stands in weights.parquet, in face units.
"""

import argparse
from collections.abc import Sequence

from stages import cli
from stages.core import compose, local_shapes
from stages.files import rig, series, weights


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, of controls")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument("--controls", required=True, help="controls.parquet to write")
    parser.add_argument("--csv", required=True, help="controls.csv to write: the same as text")
    return parser


def main(argv: Sequence[str]) -> None:
    """Compose every frame's values of the controls."""
    options = build_parser().parse_args(argv)
    character = rig.read(options.rig, "controls")
    played = weights.read(options.weights, character.names)
    masked = local_shapes.masked(character.deltas, character.masks, character.mask_index)
    values = compose.compose(character.neutral, compose.blocks(masked), played.shapes)[:, :, 0]
    columns = dict(zip(character.controls, values.T, strict=True))
    sources = [options.rig, options.weights]
    frame, time_s, rate = played.frame, played.time_s, played.rate
    series.write(options.controls, "controls", frame, time_s, columns, rate, {}, sources)
    weights.write_csv(options.csv, frame, time_s, columns)


if __name__ == "__main__":
    cli.run_stage(main)
