"""Gather the extremes that an actor and a character share, from frames that a person picked.

Each extreme is the actor's points on its frame less the neutral: markers, points of the film, or
both in one vector, brought to one measure by `balance`. What only one side has is reported and the
rest is used, as long as a layer has two extremes. Points that were not observed on one of the
frames are left out and reported. For the lip bias the distance of the lips on the frame of
speech m counts as closed, and where the character's lips touch in its speech m, they should.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import coordinate_balance, lip_seam, near_extremes
from stages.files import (
    actor_masks,
    character_lips,
    errors,
    expressions,
    extremes,
    layer_points,
    lip_shots,
    picked_frames,
    poses,
    rig,
    simplices,
)

SHOWN = 3  # faults that an error names
MOST_LEFT_OUT = 0.5  # of the points
SAME = 0.05  # of the mean distance in a layer, between extremes that are one
STILL = 1e-6  # what rounding may move [face units]
SHUT = 0.0125  # gap of closed lips [face units]
CLOSED = "_".join(extremes.CLOSED_LIPS)
Row = tuple[str, str, str, str]


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--actor", required=True, help="name of the actor")
    parser.add_argument("--expression-table", required=True, help="the frames picked, .tsv")
    parser.add_argument("--mask-table", required=True, help="masks of the actor's points, .tsv")
    parser.add_argument(
        "--shots",
        required=True,
        nargs="*",
        help="names of the basis shots, none before any is picked",
    )
    parser.add_argument("--expressions", required=True, nargs="*", help="their expressions")
    parser.add_argument("--points", required=True, choices=list(layer_points.KINDS))
    parser.add_argument("--poses", required=True, help="extremes of the character, .parquet")
    parser.add_argument("--rig", required=True, help="rig.npz of the character, for its masks")
    parser.add_argument("--extremes", required=True, help="table of all extremes")
    parser.add_argument("--balance", required=True, choices=coordinate_balance.RULES)
    parser.add_argument(
        "--lip-points", required=True, help="upper,lower: points that show lip closures, or empty"
    )
    parser.add_argument("--lip-mask", required=True, help="the mask of the lips")
    parser.add_argument(
        "--lip-sigma", required=True, type=float, help="of the lip bias [face units]; 0 for none"
    )
    parser.add_argument("--simplices", required=True, help="simplices.npz to write")
    parser.add_argument("--report", required=True, help="what became of each extreme, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read both sides, find what they share, check it, write it."""
    options = build_parser().parse_args(argv)
    if not 0 <= options.lip_sigma < np.inf:
        raise errors.InputError("--lip-sigma", f"is {options.lip_sigma:g}: give 0 or more")
    known = extremes.read(options.extremes)
    table = options.expression_table
    picked = expressions.read(table, options.actor, options.shots, known)
    actor = picked_frames.read(options.expressions, options.shots, options.points, picked)
    expressions.check_frames(table, picked, actor.frames)
    shared, report = _shared(options, known, picked)
    basis = np.stack([picked_frames.offset_of(actor, row) for row in shared], axis=1)
    layout, basis, missing = _observed(options, actor.layout, shared, basis)
    layout, basis, masks, unused = _masked(options, actor, layout, basis)
    own = rig.read_any(options.rig).mask_names
    actor_masks.check_names(options.mask_table, options.actor, masks.names, own)
    layers = list(dict.fromkeys(row.layer for row in shared))
    layer = np.array([layers.index(row.layer) for row in shared])
    mask_weights = masks.weights[:, layer_points.point_of(layout)]
    scale = _balance(options, layout, basis, mask_weights)
    _check_apart(table, shared, basis, scale, layer)
    names = [(row.layer, row.name) for row in shared]
    lips = _lips(options, actor, picked, shared, masks.names)
    lip_mask, closed_gap, opened, told = "", np.nan, np.zeros(len(shared)), (0.0 * scale, 0.0)
    if lips is not None:
        lip_mask, closed = options.lip_mask, names.index(extremes.CLOSED_LIPS)
        seen = lip_shots.at(lips, actor, shared)
        closed_gap, opened = float(seen[closed]), _open(options, names, seen)
        under = mask_weights[masks.names.index(lip_mask)] > 0.5
        told = lip_shots.told(lips, actor, layout, scale, under, basis[:, closed])
    made = simplices.Simplices(
        layers,
        names,
        masks.names,
        layout,
        options.points,
        basis,
        scale,
        mask_weights,
        layer,
        options.lip_points if lip_mask else "",
        lip_mask,
        closed_gap,
        opened,
        *told,
    )
    sources = [table, options.mask_table, *options.expressions, options.poses]
    simplices.write(options.simplices, made, {"balance": options.balance}, sources)
    report += missing + unused
    simplices.write_report(options.report, report)
    for row in report:
        if row[2] != simplices.USED:
            cli.logger.info(
                "%s: %s", " ".join(cell for cell in row[:2] if cell), ", ".join(row[2:])
            )


def _shared(
    options: argparse.Namespace,
    known: Sequence[extremes.Extreme],
    picked: Sequence[expressions.Picked],
) -> tuple[list[expressions.Picked], list[Row]]:
    """Return the extremes that both sides have, in layers with two or more, and a report."""
    lines = {(row.layer, row.name): row for row in picked}
    posed = {(pose.layer, pose.name): pose for pose in poses.read(options.poses)}
    both = [lines[extreme] for extreme in lines if extreme in posed]
    counts = {layer: sum(row.layer == layer for row in both) for layer in extremes.LAYERS}
    report = []
    for layer, name in ((each.layer, each.name) for each in known):
        extreme = layer, name
        if extreme in lines and extreme in posed:
            state, detail = simplices.USED, f"{lines[extreme].shot} {lines[extreme].frame}"
            if counts[layer] < 2:
                state, detail = simplices.LEFT_OUT, f"no second extreme of layer {layer} is shared"
        elif extreme in lines:
            state, detail = "missing on the character", f"save its pose as {layer}_{name}"
        elif extreme in posed:
            state, detail = "missing on the actor", "pick a frame that shows it"
        else:
            continue
        report.append((layer, name, state, detail))
    shared = [row for row in both if counts[row.layer] > 1]
    if not shared:
        message = "no layer has two extremes that the actor has too"
        raise errors.InputError(options.poses, f"{message}: save poses, or pick frames for them")
    for layer in extremes.LAYERS:
        if counts[layer] < 2:
            cli.logger.warning("layer %s is left out: actor and character share no two", layer)
    return shared, report


def _observed(
    options: argparse.Namespace,
    layout: layer_points.Layout,
    shared: Sequence[expressions.Picked],
    basis: np.ndarray,
) -> tuple[layer_points.Layout, np.ndarray, list[Row]]:
    """Leave out the points that were not observed on every frame, and report them."""
    names, point_of = layer_points.point_names(layout), layer_points.point_of(layout)
    lost = ~np.isfinite(basis)
    left_out, report = [], []
    for place in np.unique(point_of[lost.any(axis=1)]).tolist():
        row = shared[int(lost[point_of == place].any(axis=0).argmax())]
        where = f"not observed on {row.layer} {row.name}, frame {row.frame} of {row.shot}"
        left_out.append(place)
        report.append(("", names[place], simplices.LEFT_OUT, where))
    if len(left_out) > MOST_LEFT_OUT * len(names):
        message = f"{len(left_out)} of the {len(names)} points were not observed on some frame"
        cure = "pick frames on which they are seen"
        example = f"such as {report[0][1]}, {report[0][3]}"
        raise errors.InputError(options.expression_table, f"{message}, {example}: {cure}")
    kept = ~np.isin(point_of, left_out)
    return layer_points.without(layout, left_out), basis[kept], report


def _masked(
    options: argparse.Namespace,
    actor: picked_frames.PickedFrames,
    layout: layer_points.Layout,
    basis: np.ndarray,
) -> tuple[layer_points.Layout, np.ndarray, actor_masks.ActorMasks, list[Row]]:
    """Read the masks of the points, and leave out the points that the table gives no weight."""
    names = layer_points.point_names(layout)
    masks = actor_masks.read(options.mask_table, options.actor, names, actor.known)
    used = masks.weights.any(axis=0)
    left_out = np.flatnonzero(~used)
    report = [("", names[i], simplices.LEFT_OUT, "has weight 0 in the masks") for i in left_out]
    kept = used[layer_points.point_of(layout)]
    masks = masks._replace(weights=masks.weights[:, used])
    return layer_points.without(layout, left_out.tolist()), basis[kept], masks, report


def _balance(
    options: argparse.Namespace, layout: layer_points.Layout, basis: np.ndarray, masks: np.ndarray
) -> np.ndarray:
    """Return the factors (D,) of the coordinates."""
    group = layer_points.group_of(layout)
    for number, own in enumerate(layout):
        if np.abs(basis[group == number]).max() < STILL:
            message = f"the {own.kind} points are at the neutral in every extreme"
            raise errors.InputError(options.expression_table, f"{message}: pick other frames")
    return coordinate_balance.factors(basis, group, masks, options.balance)


def _check_apart(
    table: str,
    shared: Sequence[expressions.Picked],
    basis: np.ndarray,
    scale: np.ndarray,
    layer: np.ndarray,
) -> None:
    """Refuse extremes of one layer that nearly coincide, and warn of those that are near."""
    same = []
    cure = "pick frames that differ more, or remove one of the two"
    for pair in near_extremes.find(basis * scale[:, None], layer):
        first, second = shared[pair.first], shared[pair.second]
        apart = np.sqrt(np.mean((basis[:, pair.first] - basis[:, pair.second]) ** 2))
        lines = f"lines {first.line} and {second.line}: {first.layer} {first.name}"
        share = f"{pair.share:.1%} of the mean distance in the layer"
        named = f"{lines} and {second.name} are {apart:.2g} face units apart, {share}"
        if pair.share < SAME:
            same.append(named)
        else:
            cli.logger.warning("%s: %s, it may not tell them apart; %s", table, named, cure)
    if same:
        more = f", and {len(same) - SHOWN} more pairs" if len(same) > SHOWN else ""
        raise errors.InputError(table, f"{'; '.join(same[:SHOWN])}{more}: {cure}")


def _lips(
    options: argparse.Namespace,
    actor: picked_frames.PickedFrames,
    picked: Sequence[expressions.Picked],
    shared: Sequence[expressions.Picked],
    masks: Sequence[str],
) -> dict[str, np.ndarray] | None:
    """Return the gap of the lips in every shot (T,) [face units]; None without a lip bias."""
    if options.lip_sigma == 0 or all(row.layer != extremes.CLOSED_LIPS[0] for row in shared):
        return None
    off = "set lip_sigma to 0 in characters.tsv to do without the lip bias"
    closed = lip_shots.closed_row(options.expression_table, options.actor, picked, off)
    if closed not in shared:
        message = f"the character has no pose {CLOSED}, the closed lips"
        raise errors.InputError(options.poses, f"{message}: make it, or {off}")
    if options.lip_mask not in masks:
        message = f"'{options.lip_mask}' is no mask, they are {', '.join(masks)}"
        raise errors.InputError("--lip-mask", f"{message}: correct it in characters.tsv, or {off}")
    if not options.lip_points:
        message = "is empty: name two points of the lips in sessions.tsv"
        raise errors.InputError("--lip-points", f"{message}, or {off}")
    gaps = lip_shots.read(options.expressions, options.shots, options.lip_points, actor)
    if not np.isfinite(lip_shots.at(gaps, actor, [closed])).all():
        message = f"line {closed.line}: {options.lip_points} were not observed on that frame"
        cure = f"pick another for {closed.name}"
        raise errors.InputError(options.expression_table, f"{message}: {cure}")
    return gaps


def _open(
    options: argparse.Namespace, names: list[tuple[str, str]], gaps: np.ndarray
) -> np.ndarray:
    """Return how far the lips of each extreme are open (K,), given the actor's gaps (K,)."""
    closed = names.index(extremes.CLOSED_LIPS)
    own = np.maximum(gaps - gaps[closed], 0.0)
    shapes = character_lips.read(rig.read_any(options.rig), options.lip_mask, names)
    found = None if shapes is None else lip_seam.gaps(shapes, closed)
    if found is None:
        message = f"no vertices of mask {options.lip_mask} touch in {CLOSED} and part in a pose"
        cli.logger.info("%s: %s, the actor's gaps are used", options.rig, message)
        if np.isnan(own).any():
            name = "_".join(names[int(np.isnan(own).argmax())])
            message = f"{options.lip_points} were not observed on the frame of {name}"
            raise errors.InputError(options.expression_table, f"{message}: pick another")
        return own
    apart = [n for n, a, b in zip(names, own, found, strict=True) if a < SHUT and b > 4 * SHUT]
    if apart:
        text = ", ".join("_".join(name) for name in apart)
        cli.logger.info("%s: open where the actor's lips are closed: %s", options.poses, text)
    return found


if __name__ == "__main__":
    cli.run_stage(main)
