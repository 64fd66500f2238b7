"""Write a take's curves with as few keys as its mesh allows, for people who edit them.

Programs have to interpolate linearly between the keys. The bound on the mesh holds at every time,
before the head moves; the head's motion has no keys here.
"""

import argparse
from collections.abc import Sequence

from stages import cli
from stages.core import key_reduction, sculpt_checks
from stages.files import errors, key_table, take


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument(
        "--tolerance",
        type=float,
        default=0.001,
        help="farthest that a vertex may move, as a share of the character's size",
    )
    parser.add_argument("--key-table", required=True, help="keys.csv to write: a row for each key")
    parser.add_argument("--error", required=True, help="keys.json to write: counts and error")
    return parser


def main(argv: Sequence[str]) -> None:
    """Choose the keys, write them and what they cost."""
    options = build_parser().parse_args(argv)
    if not 0 < options.tolerance < 1:
        message = f"{options.tolerance:g} is no share of the size: give one between 0 and 1"
        raise errors.InputError("--tolerance", message)
    played = take.read(options.rig, options.weights)
    character, values = played.character, played.motion.weights
    size = sculpt_checks.diagonal(character.neutral)
    if not size > 0:
        raise errors.InputError(options.rig, "the character has no size: give it another neutral")
    kept, worst = key_reduction.reduce(values, played.masked, options.tolerance * size)
    key_table.write(options.key_table, character.names, played.frame, values, kept)
    counts = dict(zip(character.names, kept.sum(axis=0).tolist(), strict=True))
    key_table.write_error(
        options.error,
        counts,
        {
            "keys_per_second": sum(counts.values()) * float(played.rate) / len(played.frame),
            "tolerance": options.tolerance,
            "worst_error": worst,
            "worst_error_share": worst / size,
            "size": size,
            "unit": character.unit,
            "fps_num": played.rate.numerator,
            "fps_den": played.rate.denominator,
            "first_frame": int(played.frame[0]),
            "last_frame": int(played.frame[-1]),
            "first_timecode": played.first_timecode,
        },
    )


if __name__ == "__main__":
    cli.run_stage(main)
