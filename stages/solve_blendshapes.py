"""Solve the weights of a rig's shapes from points and their places on its mesh (D06 eq. 7).

Weights are NaN on frames with less than half of the points, and their confidence is 0. The strength
of `clip` is multiplied by each channel's own, and by 0.02 on channels that blink.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import equation, head_transform, kept_moments, local_shapes
from stages.files import channels, driving_points, errors, rig, series, virtual_markers


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--expression", required=True, help="the shot's expression, .parquet")
    parser.add_argument(
        "--points", required=True, choices=list(driving_points.AXES), help="which of its points"
    )
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--virtual-markers", required=True, help="table of point and vertex")
    parser.add_argument("--channels", required=True, help="table of the channels, or ''")
    parser.add_argument("--solve", required=True, choices=equation.METHODS, help="the solve")
    parser.add_argument(
        "--strength",
        required=True,
        type=float,
        help="of clip, 0 or more: 1 keeps half of a usual shape's motion at 10 Hz",
    )
    parser.add_argument("--solved", required=True, help="weights to write, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read points and rig, solve, write the weights."""
    options = build_parser().parse_args(argv)
    if not 0 <= options.strength < float("inf"):
        raise errors.InputError("--strength", f"is {options.strength:g}: give 0 or more")
    driving = driving_points.read(options.expression, options.points)
    character = rig.read(options.rig, "mesh")
    listed = virtual_markers.read(options.virtual_markers, driving.names, len(character.neutral))
    left_out = [name for i, name in enumerate(driving.names) if i not in listed.points]
    if left_out:
        cli.logger.info("not used, they have no virtual marker: %s", ", ".join(left_out))
    places, deltas = _on_the_mesh(character, listed, driving.points.shape[2])
    limits = channels.read(options.channels, character.names, 0.0, 1.0)
    blinks = np.array(kept_moments.kinds(character.names, limits.keep)) == kept_moments.BLINK
    strength = options.strength * limits.strength * np.where(blinks, equation.BLINK_STRENGTH, 1.0)
    try:
        solution = equation.solve(
            driving.points[:, listed.points],
            driving.neutral[listed.points],
            places,
            deltas,
            options.solve,
            limits.low,
            limits.high,
            strength,
            float(driving.rate),
        )
    except ValueError as error:
        raise errors.InputError(options.virtual_markers, f"{error}") from error
    solved = np.isfinite(solution.residual)
    columns = dict(zip(character.names, solution.weights.T, strict=True))
    columns["residual"] = solution.residual
    columns["kkt_residual"] = solution.kkt_residual
    columns["confidence"] = np.where(solved, driving.confidence, 0.0)
    sources = [options.expression, options.rig, options.virtual_markers]
    sources += [options.channels] if options.channels else []
    series.write(
        options.solved,
        "solved",
        driving.frame,
        driving.time_s,
        columns,
        driving.rate,
        {"residual_unit": "face units", "solve": options.solve},
        sources,
    )


def _on_the_mesh(
    character: rig.Rig, listed: virtual_markers.VirtualMarkers, dimensions: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the places (M, D) and what each shape adds (K, M, D), in the face's axes and unit."""
    masked = local_shapes.masked(character.deltas, character.masks, character.mask_index)
    vertices, shares = listed.vertices, listed.shares[:, :, None]
    moved = local_shapes.at(masked, vertices.ravel())
    moved = moved.reshape(len(moved), *vertices.shape, 3)
    axes = head_transform.face_axes(character.up_axis) / character.face_unit
    places = np.sum(shares * character.neutral[vertices], axis=1) @ axes
    return places[:, :dimensions], (np.sum(shares * moved, axis=2) @ axes)[:, :, :dimensions]


if __name__ == "__main__":
    cli.run_stage(main)
