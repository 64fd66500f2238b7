"""Choose the key shapes of every region from an actor's basis shots (CB02 section 4.2).

Also measures every method at several counts, on the frames that it chose from and on blocks of
time that it did not see.
"""

import argparse
from collections.abc import Sequence
from functools import partial

import numpy as np

from stages import cli
from stages.core import (
    key_shape_candidates,
    key_shape_count,
    key_shape_errors,
    key_shape_selection,
    key_weights,
    pca,
    region_features,
)
from stages.files import basis, errors, key_shapes, lock_table, model, region_settings, regions

COUNTS = (2, 4, 8, 12, 16, 24)


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--expressions", required=True, nargs="+", help="basis shots' expressions, .parquet"
    )
    parser.add_argument("--shots", required=True, nargs="+", help="names of these shots")
    parser.add_argument("--regions", required=True, help="table of regions")
    parser.add_argument("--region-settings", required=True, help="table of their settings")
    parser.add_argument("--key-shape-table", required=True, help="table of locks and bans")
    parser.add_argument("--actor", required=True, help="whose rows of that table count")
    parser.add_argument("--pca", required=True, help="axes of every region, .npz")
    parser.add_argument(
        "--min-confidence",
        required=True,
        type=float,
        help="frames of lower confidence, 0 to 1, are never chosen",
    )
    parser.add_argument("--seed", required=True, type=int, help="seed of the clustering")
    parser.add_argument("--key-shapes", required=True, help="key shapes to write, .parquet")
    parser.add_argument("--errors", required=True, help="errors to write, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read basis, axes and locks; choose and measure per region; write both tables."""
    arguments = build_parser().parse_args(argv)
    frames = basis.read(arguments.expressions, arguments.shots)
    table = regions.read(arguments.regions)
    settings = region_settings.read(arguments.region_settings, table)
    place = {key: row for row, key in enumerate(zip(frames.shot, frames.frame, strict=True))}
    locks = lock_table.read(arguments.key_shape_table, arguments.actor, place)
    axes, _ = model.read(arguments.pca, "pca")
    shapes, curves = [], []
    chosen_points = {}
    for region in table:
        chosen, weights = regions.select(arguments.regions, table, region, frames.names)
        chosen_points[region] = chosen
        confidence = basis.region_confidence(frames, chosen)
        candidates = key_shape_candidates.Candidates(
            region_features.stack(frames.points[:, chosen], weights),
            region_features.stack(frames.neutral[chosen], weights),
            pca.Pca(*(axes[f"{region}.{part}"] for part in pca.Pca._fields)),
            _eligible(arguments, frames, region, locks, confidence),
            tuple(locks.get(region, {}).get("locked", ())),
            arguments.seed,
            settings[region].sigma,
        )
        rows = _measure(candidates, frames, settings[region])
        curves += [{"region": region} | row for row in rows]
        choices, why = _choose(arguments, region, candidates, settings[region], rows)
        shapes += [
            _key_shape(frames, region, order, choice, settings[region].method)
            | {
                "locked": choice.frame in candidates.locked,
                "confidence": float(confidence[choice.frame]),
                "count_reason": why,
                "shape": frames.points[choice.frame, chosen].ravel().tolist(),
            }
            for order, choice in enumerate(choices)
        ]
    sources = [*arguments.expressions, arguments.pca]
    names = {region: [frames.names[i] for i in rows] for region, rows in chosen_points.items()}
    neutral = {region: frames.neutral[rows].ravel() for region, rows in chosen_points.items()}
    key_shapes.write(arguments.key_shapes, shapes, names, neutral, sources)
    key_shapes.write_errors(arguments.errors, curves, sources)


def _eligible(
    arguments: argparse.Namespace,
    frames: basis.Basis,
    region: str,
    locks: lock_table.Locks,
    confidence: np.ndarray,
) -> np.ndarray:
    """Return which frames (T,) a selector may take; warn of locked ones that it could not."""
    states = locks.get(region, {"locked": [], "banned": []})
    eligible = confidence >= arguments.min_confidence
    for row in states["locked"]:
        where = f"region {region}: locked frame {frames.frame[row]} of shot {frames.shot[row]}"
        if confidence[row] == 0:
            message = f"{where} was not tracked: label it, or lock another"
            raise errors.InputError(arguments.key_shape_table, message)
        if not eligible[row]:
            text = f"has confidence {confidence[row]:.2f}, below {arguments.min_confidence:g}"
            cli.logger.warning("%s: %s %s: kept", arguments.key_shape_table, where, text)
    eligible[states["banned"]] = False
    return eligible


def _measure(
    candidates: key_shape_candidates.Candidates,
    frames: basis.Basis,
    setting: region_settings.Settings,
) -> list[dict]:
    """Return method, count, split and rms of every method on blocks of time."""
    fixed = [setting.count] if isinstance(setting.count, int) else []
    solve = partial(
        key_weights.solve, method=setting.solve, sigma=setting.sigma, bound=setting.bound
    )
    counts = sorted({*COUNTS, *fixed})
    few = counts if setting.method == key_shape_errors.SLOW else fixed or [12]
    found = key_shape_errors.curves(candidates, frames.shot, frames.frame, counts, few, solve)
    columns = ("method", "count", "split", "rms")
    return [dict(zip(columns, row, strict=True)) for row in found]


def _choose(
    arguments: argparse.Namespace,
    region: str,
    candidates: key_shape_candidates.Candidates,
    setting: region_settings.Settings,
    rows: Sequence[dict],
) -> tuple[list[key_shape_candidates.Choice], str]:
    """Return the choices of a region and why it has as many."""
    own = [row for row in rows if row["method"] == setting.method and row["split"] == "held_out"]
    counts, held_out = [row["count"] for row in own], [row["rms"] for row in own]
    try:
        count, why = setting.count, "set in region_settings.tsv"
        if count == "knee":
            count, why = key_shape_count.at_knee(counts, held_out)
        if count == "budget":
            count, why = key_shape_count.within_budget(counts, held_out, setting.budget)
        if setting.count != count and count < len(candidates.locked):
            count, why = len(candidates.locked), f"as many are locked; {why} ({count})"
        return key_shape_selection.choose(candidates, count, setting.method), why
    except ValueError as error:
        raise errors.InputError(arguments.region_settings, f"region {region}: {error}") from None


def _key_shape(
    frames: basis.Basis, region: str, order: int, choice: key_shape_candidates.Choice, method: str
) -> dict:
    """Return the cells of a key shape that tell where it stands."""
    shot, frame = str(frames.shot[choice.frame]), int(frames.frame[choice.frame])
    name = key_shapes.name_of(shot, frame)
    where = {"region": region, "key_shape": name, "shot": shot, "frame": frame}
    return where | {"order": order, "method": method, "reason": choice.reason}


if __name__ == "__main__":
    cli.run_stage(main)
