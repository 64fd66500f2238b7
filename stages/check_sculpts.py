"""State what a character's sculpts are: present, missing or suspicious, and what to do.

It never fails over a sculpt: the brief shows what it finds, and `assemble_rig` refuses gaps.
"""

import argparse
import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages import cli
from stages.core import contradictions, sculpt_checks
from stages.files import errors, key_shapes, sculpt_states, sculpts


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--key-shapes", required=True, help="key_shapes.parquet of the actor")
    parser.add_argument("--neutral", required=True, help="the neutral: .obj, .ply or .csv")
    parser.add_argument("--sculpts", nargs="*", default=[], help="the sculpts that exist, if any")
    parser.add_argument("--sculpt-folder", required=True, help="<this>/<region>/<key shape>.<ext>")
    parser.add_argument("--character", required=True, help="its name")
    parser.add_argument("--states", required=True, help="sculpts.parquet to write")
    return parser


def _read(
    states: sculpt_states.StateTable, neutral: sculpts.Pose, present: set[Path]
) -> dict[sculpt_states.Key, np.ndarray]:
    """Read the sculpts; return how those that can be read differ from the neutral."""
    size = sculpt_checks.diagonal(neutral.coordinates)
    offsets = {}
    for key, row in states.rows.items():
        path = Path(row["path"])
        if path not in present:
            states.set(key, "missing", "not there yet", f"sculpt it and save it as {path}")
            continue
        try:
            coordinates, same = sculpts.read_sculpt(path, neutral)
        except errors.InputError as error:
            what, _, cure = str(error).removeprefix(f"{path}: ").rpartition(": ")
            states.suspect(key, what, cure)
            continue
        if not same:
            cure = "export with the vertex order kept, as the neutral was"
            states.suspect(key, "its polygons are not the neutral's", cure)
        if sculpt_checks.equal(coordinates, neutral.coordinates, size):
            states.suspect(key, "equal to the neutral", "sculpt it, then save again")
            continue
        fault = None
        if not neutral.is_controls:
            fault = sculpt_checks.placement_fault(coordinates, neutral.coordinates)
        if fault:
            states.suspect(key, *fault)
        elif same:
            offsets[key] = coordinates - neutral.coordinates
    return offsets


def _find_equals(
    states: sculpt_states.StateTable, region: str, offsets: dict[str, np.ndarray], size: float
) -> None:
    """Look for sculpts of a region that are equal to each other."""
    for pair in itertools.combinations(offsets, 2):
        if sculpt_checks.equal(*(offsets[name] for name in pair), size):
            for name, other in itertools.permutations(pair):
                cure = f"sculpt the one of the two that is not yet itself, {name} or {other}"
                states.suspect((region, name), f"equal to {other}", cure)


def _find_contradictions(
    states: sculpt_states.StateTable,
    region: str,
    actor: dict[str, np.ndarray],
    offsets: dict[str, np.ndarray],
    is_controls: bool,
) -> None:
    """Look for sculpts of a region that contradict the actor."""
    names = list(offsets)
    source = np.stack([actor[name] for name in names])
    target = np.stack([offsets[name].ravel() for name in names])
    if is_controls:
        target = contradictions.by_range(target)
    grams = source @ source.T, target @ target.T
    pairs = contradictions.exchanged_pairs(*grams)
    for i, j in pairs:
        for name, other in itertools.permutations((names[i], names[j])):
            cure = f"compare both with the brief: exchange the files of {name} and {other}?"
            states.suspect((region, name), f"fits the actor only in place of {other}", cure)
    exchanged = {row for pair in pairs for row in pair}
    for i, j in contradictions.reversed_extremes(*grams):
        if not {i, j} & exchanged:
            what = f"the actor goes farther than in {names[j]}, the sculpt goes less far"
            cure = f"make {names[i]} stronger than {names[j]}, or {names[j]} weaker"
            states.suspect((region, names[i]), what, cure)


def main(argv: Sequence[str]) -> None:
    """Check each sculpt, then the sculpts of each region against one another."""
    options = build_parser().parse_args(argv)
    actor = key_shapes.read_offsets(options.key_shapes)
    paths = {
        (region, name): sculpts.path_of(options.sculpt_folder, region, name, options.neutral)
        for region, shapes in actor.items()
        for name in shapes
    }
    states = sculpt_states.StateTable(paths)
    try:
        neutral = sculpts.read_neutral(options.neutral)
    except errors.InputError as error:
        for key in paths:
            states.set(key, "missing", f"no neutral to compare with ({error})", "mend the neutral")
    else:
        present = {Path(path) for path in options.sculpts}
        offsets = _read(states, neutral, present)
        size = sculpt_checks.diagonal(neutral.coordinates)
        for region, shapes in actor.items():
            read = {name: offsets[region, name] for name in shapes if (region, name) in offsets}
            if read:
                _find_equals(states, region, read, size)
                _find_contradictions(states, region, shapes, read, neutral.is_controls)
    states.add_unused(options.sculpts)
    rows = list(states.rows.values())
    sculpt_states.write(options.states, rows, [options.key_shapes, *options.sculpts])
    found = [row["state"] for row in rows]
    counts = ", ".join(f"{found.count(state)} {state}" for state in dict.fromkeys(found))
    cli.logger.info("%s: %s", options.character, counts)


if __name__ == "__main__":
    cli.run_stage(main)
