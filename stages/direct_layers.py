"""Put the layers of a take together for its character, each turned up or down as directed.

Writes the weight of every column of the rig, ``u_lk = w_lj a_k amplitude_l gain``; what gains below
one take goes to the layer's neutral, if that is a pose of its own. An extreme that the actor lacks
has weight 0. Frames that were not observed stay NaN.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import directing
from stages.files import directing_table, errors, extremes, layers, rig, series


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--layers", required=True, help="layers.parquet of the take")
    parser.add_argument("--rig", required=True, help="rig.npz of the character, of its extremes")
    parser.add_argument("--directing", required=True, help="table of gains, or ''")
    parser.add_argument("--character", required=True, help="its name in that table")
    parser.add_argument("--shot", required=True, help="the take's shot in that table")
    parser.add_argument("--extremes", required=True, help="table of all extremes")
    parser.add_argument("--directed", required=True, help="weights to write, .parquet")
    return parser


def _columns(
    options: argparse.Namespace, character: rig.Rig, take: layers.Layers
) -> list[tuple[int, int] | None]:
    """Return mask and extreme of each of the rig's columns; None where the take has none."""
    place = {"_".join(extreme): k for k, extreme in enumerate(take.extremes)}
    found: list[tuple[int, int] | None] = []
    absent = []
    for name, mask_index in zip(character.names, character.mask_index, strict=True):
        mask = character.mask_names[mask_index]
        extreme = name.removeprefix(f"{mask}.")
        if extreme.partition("_")[0] not in extremes.LAYERS:
            message = f"'{name}' is of no layer: give the rig that assemble_poses made"
            raise errors.InputError(options.rig, message)
        if mask not in take.masks:
            message = f"has no mask '{mask}' of the character, it has {', '.join(take.masks)}"
            raise errors.InputError(options.layers, message + ": see actor_masks.tsv")
        if extreme in place:
            found.append((take.masks.index(mask), place[extreme]))
        else:
            found.append(None)
            absent.append(extreme)
    if absent:
        names = ", ".join(dict.fromkeys(absent))
        cli.logger.info("not among the take's extremes, so they rest: %s", names)
    return found


def main(argv: Sequence[str]) -> None:
    """Read layers and gains, compose, write."""
    options = build_parser().parse_args(argv)
    take = layers.read(options.layers)
    character = rig.read_any(options.rig)
    known = extremes.read(options.extremes)
    rows = directing_table.read(options.directing, known, options.character, options.shot)
    for row in rows:
        if not set(row.extremes) & set(take.extremes):
            where = f"{options.directing}, line {row.line}"
            cli.logger.warning("%s: the take holds none of it, so it does nothing", where)
    places = _columns(options, character, take)
    directions = directing_table.directions(rows, take.extremes)
    weights = directing.composed(
        take.weights,
        take.coefficients,
        take.amplitudes,
        np.array([take.layers.index(layer) for layer, _ in take.extremes]),
        directing.gains(take.time_s, len(take.extremes), directions),
        np.array(extremes.rests(take.layers, take.extremes)),
    )
    # a rest that is not observed is not known either: whole frames are filled later
    rest = np.where(np.isfinite(take.weights).all(axis=(1, 2)), 0.0, np.nan)
    columns = {
        name: rest if place is None else weights[:, place[0], place[1]]
        for name, place in zip(character.names, places, strict=True)
    }
    columns["confidence"] = take.confidence
    sources = [options.layers, options.rig, options.extremes]
    sources += [options.directing] if options.directing else []
    series.write(
        options.directed, "directed", take.frame, take.time_s, columns, take.rate, {}, sources
    )


if __name__ == "__main__":
    cli.run_stage(main)
