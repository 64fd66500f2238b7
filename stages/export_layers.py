"""Write emotion, speech and blink of a take as curves of their own, as they are baked.

A CSV for each layer: frame, time_s, and `<mask>.<name>` for every pair that moves the character. A
layer that the character lacks has no curve.
"""

import argparse
from collections.abc import Sequence

from stages import cli
from stages.files import errors, extremes, rig, weights


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, of its extremes")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    for layer in extremes.LAYERS:
        parser.add_argument(f"--{layer}", required=True, help=f"{layer}.csv to write")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the weights, sort them by layer, write each."""
    options = build_parser().parse_args(argv)
    character = rig.read_any(options.rig)
    played = weights.read(options.weights, character.names)
    curves = {layer: {} for layer in extremes.LAYERS}
    for name, mask_index, curve in zip(
        character.names, character.mask_index, played.shapes.T, strict=True
    ):
        mask = character.mask_names[mask_index]
        layer, _, plain = name.removeprefix(f"{mask}.").partition("_")
        if layer not in curves:
            message = f"'{name}' is of no layer: give the rig that assemble_poses made"
            raise errors.InputError(options.rig, message)
        curves[layer][f"{mask}.{plain}"] = curve
    for layer, path in zip(
        extremes.LAYERS, (options.emotion, options.speech, options.blink), strict=True
    ):
        weights.write_csv(path, played.frame, played.time_s, curves[layer])


if __name__ == "__main__":
    cli.run_stage(main)
