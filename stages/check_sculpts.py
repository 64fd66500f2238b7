"""State what a character's sculpts are: present, missing or suspicious, and what to do.

It never fails over a sculpt: the brief shows what it finds, and `assemble_rig` refuses gaps.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages import cli
from stages.core import contradictions, sculpt_checks
from stages.files import errors, sculpts


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--key-shapes", required=True, help="key_shapes.parquet of the actor")
    parser.add_argument("--neutral", required=True, help="the neutral: .obj, .ply or .csv")
    parser.add_argument("--sculpts", nargs="*", default=[], help="the sculpts that exist, if any")
    parser.add_argument("--sculpt-folder", required=True, help="<this>/<region>/<key shape>.<ext>")
    parser.add_argument("--character", required=True, help="its name")
    parser.add_argument("--sculpts-state", required=True, help="sculpts.parquet to write")
    return parser


def _read(
    states: sculpts.StateTable, neutral: sculpts.Pose, present: set[Path]
) -> dict[sculpts.Key, np.ndarray]:
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
            states.set(key, "suspicious", what, cure)
            continue
        if not same:
            states.set(
                key, "suspicious", "its polygons are not the neutral's",
                "export with the vertex order kept, as the neutral was",
            )  # fmt: skip
        if sculpt_checks.equal(coordinates, neutral.coordinates, size):
            states.set(key, "suspicious", "equal to the neutral", "sculpt it, then save again")
            continue
        fault = None
        if not neutral.is_controls:
            fault = sculpt_checks.placement_fault(coordinates, neutral.coordinates)
        if fault:
            states.set(key, "suspicious", *fault)
        elif same:
            offsets[key] = coordinates - neutral.coordinates
    return offsets


def _compare(
    states: sculpts.StateTable,
    region: str,
    actor: dict[str, np.ndarray],
    offsets: dict[sculpts.Key, np.ndarray],
    size: float,
    is_controls: bool,
) -> None:
    """Look for sculpts of a region that are equal to, or contradict, each other."""
    names = [name for name in actor if (region, name) in offsets]
    for row, name in enumerate(names):
        for other in names[:row]:
            if sculpt_checks.equal(offsets[region, name], offsets[region, other], size):
                for one, two in ((name, other), (other, name)):
                    states.set(
                        (region, one), "suspicious", f"equal to {two}",
                        f"sculpt the one of the two that is not yet itself, {one} or {two}",
                    )  # fmt: skip
    if not names:
        return
    source = np.stack([actor[name] for name in names])
    target = np.stack([offsets[region, name].ravel() for name in names])
    if is_controls:
        target = contradictions.by_range(target)
    grams = source @ source.T, target @ target.T
    pairs = contradictions.exchanged_pairs(*grams)
    for i, j in pairs:
        for one, two in ((names[i], names[j]), (names[j], names[i])):
            states.set(
                (region, one), "suspicious", f"fits the actor only in place of {two}",
                f"compare both with the brief: exchange the files of {one} and {two}?",
            )  # fmt: skip
    exchanged = {row for pair in pairs for row in pair}
    for i, j in contradictions.reversed_extremes(*grams):
        if not {i, j} & exchanged:
            states.set(
                (region, names[i]), "suspicious",
                f"the actor goes farther than in {names[j]}, the sculpt goes less far",
                f"make {names[i]} stronger than {names[j]}, or {names[j]} weaker",
            )  # fmt: skip


def main(argv: Sequence[str]) -> None:
    """Check each sculpt, then the sculpts of each region against one another."""
    options = build_parser().parse_args(argv)
    actor = sculpts.actor_offsets(options.key_shapes)
    paths = {
        (region, name): sculpts.path_of(options.sculpt_folder, region, name, options.neutral)
        for region, shapes in actor.items()
        for name in shapes
    }
    states = sculpts.StateTable(paths)
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
            _compare(states, region, shapes, offsets, size, neutral.is_controls)
    states.add_unused(options.sculpts)
    rows = list(states.rows.values())
    sculpts.write_states(options.sculpts_state, rows, [options.key_shapes, *options.sculpts])
    found = [row["state"] for row in rows]
    counts = ", ".join(f"{found.count(state)} {state}" for state in dict.fromkeys(found))
    cli.logger.info("%s: %s", options.character, counts)


if __name__ == "__main__":
    cli.run_stage(main)
