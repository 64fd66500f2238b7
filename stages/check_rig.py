"""State what looks wrong with a rig: sides, sizes, units, what mouthClose means, what it lacks.

It never fails over a rig that can be read; the report repeats what it finds.
"""

import argparse
from collections.abc import Sequence

from stages import cli
from stages.core import rig_checks
from stages.files import delimited, rig, shape_names


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--names", required=True, help="table of the shapes' names")
    parser.add_argument("--checks", required=True, help="table of the findings to write, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read the rig, match its names, write the findings."""
    options = build_parser().parse_args(argv)
    character, table = rig.read_any(options.rig), shape_names.read(options.names)
    names = [name.partition(".")[2] for name in character.names]
    findings = rig_checks.find(
        names,
        character.neutral,
        character.deltas,
        {shape.name: shape_names.spelt(shape, names) for shape in table},
        {shape.name: shape.mirror for shape in table if shape.side == "left"},
        (character.up_axis, character.face_unit, rig.METRES[character.unit]),
    )
    delimited.write(options.checks, rig_checks.Finding._fields, findings)
    cli.logger.info("%d shapes, %d things to look at", len(names), len(findings))


if __name__ == "__main__":
    cli.run_stage(main)
