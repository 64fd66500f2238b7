"""Lay a take on the artist's own blendshapes, so that it can be delivered in them (K11 section 5).

Per frame, the weights within their limits that bring the artist's shapes nearest to the composed
face, over all vertices and before the head moves. Of the table of channels only `low` and `high`
count. `residual` is the root mean square distance of the vertices that move, in face units.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import local_shapes, mesh_projection
from stages.files import channels, errors, rig, weights

# how far the neutrals may differ, as a share of the size: other formats round
SAME_PLACE = 1e-5


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument("--delivery-rig", required=True, help="rig.npz of the artist's shapes")
    parser.add_argument("--channels", required=True, help="table of the shapes' limits, or ''")
    parser.add_argument("--delivery", required=True, help="weights to write, .parquet")
    parser.add_argument("--csv", required=True, help="the same to write, .csv")
    return parser


def _refuse_other_vertices(options: argparse.Namespace, own: rig.Rig, other: rig.Rig) -> None:
    """Fail unless both rigs have the same vertices in the same places and unit."""
    path, cure = options.delivery_rig, "export its shapes from the character's own neutral"
    if (own.unit, own.up_axis) != (other.unit, other.up_axis):
        found, wanted = (f"{each.unit} with {each.up_axis} up" for each in (other, own))
        raise errors.InputError(path, f"is in {found}, the character in {wanted}: {cure}")
    if own.neutral.shape != other.neutral.shape:
        found, wanted = len(other.neutral), len(own.neutral)
        message = f"has {found} vertices, the character has {wanted}"
        raise errors.InputError(path, f"{message}: {cure}")
    size = np.linalg.norm(np.ptp(own.neutral, axis=0))
    distance = np.linalg.norm(own.neutral - other.neutral, axis=1)
    away = np.flatnonzero(distance > SAME_PLACE * size)
    if len(away):
        message = f"vertex {away[0]} of its neutral is not where the character has it"
        raise errors.InputError(path, f"{message} ({len(away)} such vertices): {cure}")


def main(argv: Sequence[str]) -> None:
    """Read both rigs and the take, project, write."""
    options = build_parser().parse_args(argv)
    own, other = rig.read(options.rig, "mesh"), rig.read(options.delivery_rig, "mesh")
    _refuse_other_vertices(options, own, other)
    played = weights.read(options.weights, own.names)
    limits = channels.read(options.channels, other.names, 0.0, 1.0)
    masked = (
        local_shapes.masked(each.deltas, each.masks, each.mask_index) for each in (own, other)
    )
    found, residual = mesh_projection.project(
        mesh_projection.products(*masked), played.shapes, limits.low, limits.high
    )
    columns = dict(zip(other.names, found.T, strict=True))
    columns["residual"] = residual / own.face_unit
    columns |= weights.head_columns(played.rotation, np.c_[played.translation, played.scale]) | {
        "confidence": played.confidence
    }
    meta = {"residual_unit": "face units"}
    if played.start_timecode:
        meta |= {"start_timecode": played.start_timecode}
        meta |= {"timecode_rate": str(played.timecode_rate)}
    sources = [options.rig, options.weights, options.delivery_rig]
    sources += [options.channels] if options.channels else []
    paths = options.delivery, options.csv
    weights.write(*paths, played.frame, columns, played.rate, meta, sources)


if __name__ == "__main__":
    cli.run_stage(main)
