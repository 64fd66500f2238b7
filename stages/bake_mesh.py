"""Bake a take: vertex positions as picture and point cache, and a glTF that gives the same."""

import argparse
import contextlib
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import local_shapes, morph_sides, polygons, target_pruning
from stages.files import atomic, errors, exr, gltf, pc2, rig, take


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument("--exr", required=True, help="mesh.exr to write: float32 positions")
    parser.add_argument("--json", required=True, help="mesh.json to write: its layout")
    parser.add_argument("--pc2", required=True, help="mesh.pc2 to write: a point cache")
    parser.add_argument("--glb", required=True, help="mesh.glb to write: morph targets, animated")
    parser.add_argument(
        "--most-targets",
        type=int,
        default=0,
        help="morph targets of the glTF that are active at once at most, such as 8; 0: all",
    )
    return parser


def _surface(played: take.Take, sides: morph_sides.Sides) -> gltf.Surface:
    """Cut the polygons into triangles, find the normals of the neutral, name the targets."""
    character = played.character
    triangles = polygons.triangulate(character.sizes, character.corners)
    normals = polygons.vertex_normals(character.neutral, triangles)
    names = [
        character.names[shape] + ("" if gain > 0 else ".minus")
        for shape, gain in zip(sides.shape, sides.gain, strict=True)
    ]
    targets = local_shapes.select(played.masked, sides.shape, sides.gain)
    return gltf.Surface(triangles, normals, names, sides.gain, targets)


def _form(played: take.Take) -> dict:
    """Return what the JSON says of the character."""
    character = played.character
    active = (played.motion.weights != 0) & local_shapes.touched(played.masked)
    return {
        "axes": {"up": character.up_axis, "R": "x", "G": "y", "B": "z"},
        "unit": character.unit,
        "metres_per_unit": rig.METRES[character.unit],
        "vertex_hash": rig.vertex_hash(character),
        "morph_targets_active_at_once": int(active.sum(axis=1).max()),
    }


def _pruned(
    surface: gltf.Surface, weights: np.ndarray, scale: np.ndarray, most: int, size: float
) -> tuple[np.ndarray, dict]:
    """Return the weights (T, M) that stay in the glTF, and what the JSON says of the others."""
    if not most:
        return weights, {}
    stays = target_pruning.kept(weights, target_pruning.reach(surface.targets), most)
    worst = target_pruning.worst_error(surface.targets, np.where(stays, 0.0, weights), scale)
    share = worst / size if size else 0.0
    cli.logger.info("glTF: at most %d targets at once, worst error %.3g of the size", most, share)
    return np.where(stays, weights, 0.0), {
        "glb_pruning": {"most_targets": most, "max_error": worst, "max_error_of_size": share}
    }


def main(argv: Sequence[str]) -> None:
    """Bake frame by frame, so that memory does not grow with the take."""
    options = build_parser().parse_args(argv)
    if options.most_targets < 0:
        raise errors.InputError("--most-targets", f"{options.most_targets} is negative: 0 is all")
    played = take.read(options.rig, options.weights)
    character = played.character
    vertices, frames, first = len(character.neutral), len(played.frame), int(played.frame[0])
    progress = cli.Progress("bake", frames)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    with contextlib.ExitStack() as stack:
        paths = [
            stack.enter_context(atomic.replacing(path))
            for path in (options.exr, options.json, options.pc2, options.glb)
        ]
        with (
            exr.writer(paths[0], vertices, frames) as append_exr,
            pc2.writer(paths[2], vertices, frames, first) as append_pc2,
        ):
            for positions in take.positions(played, options.weights):
                low = np.minimum(low, positions.min(axis=0))
                high = np.maximum(high, positions.max(axis=0))
                append_exr(positions)
                append_pc2(positions)
                progress.step()
        sides = morph_sides.split(played.motion.weights)
        surface = _surface(played, sides)
        size = float(np.linalg.norm(high - low))
        stay, said = _pruned(
            surface, sides.weights, played.motion.scale, options.most_targets, size
        )
        bounds = np.stack([low, high])
        form = _form(played) | said | played.start
        exr.write_json(paths[1], vertices, frames, first, played.rate, bounds, form)
        motion = played.motion._replace(weights=stay)
        clock = played.frame, played.rate, played.start
        gltf.write(paths[3], character, surface, motion, *clock)


if __name__ == "__main__":
    cli.run_stage(main)
