"""Bake a take: vertex positions as picture and point cache, and a glTF that gives the same."""

import argparse
import contextlib
import dataclasses
from collections.abc import Iterator, Sequence

import numpy as np

from stages import cli
from stages.core import compose, head_transform, local_shapes, morph_sides, polygons
from stages.files import atomic, errors, exr, gltf, pc2, rig, weights

# frames that are composed at once
CHUNK = 32


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--weights", required=True, help="weights.parquet of the take")
    parser.add_argument("--exr", required=True, help="mesh.exr to write: float32 positions")
    parser.add_argument("--json", required=True, help="mesh.json to write: its layout")
    parser.add_argument("--pc2", required=True, help="mesh.pc2 to write: a point cache")
    parser.add_argument("--glb", required=True, help="mesh.glb to write: morph targets, animated")
    return parser


def _motion(character: rig.Rig, played: weights.Weights) -> gltf.Motion:
    """Turn the head motion into the character's axes and unit."""
    axes = head_transform.face_axes(character.up_axis)
    return gltf.Motion(
        times=played.time_s,
        weights=played.shapes,
        rotation=head_transform.turned_quaternions(played.rotation, axes),
        translation=character.face_unit * played.translation @ axes.T,
        scale=played.scale,
    )


def _surface(
    character: rig.Rig, masked: local_shapes.LocalShapes, sides: morph_sides.Sides
) -> gltf.Surface:
    """Cut the polygons into triangles, find the normals of the neutral, name the targets."""
    triangles = polygons.triangulate(character.sizes, character.corners)
    normals = polygons.vertex_normals(character.neutral, triangles)
    names = [
        character.names[shape] + ("" if gain > 0 else ".minus")
        for shape, gain in zip(sides.shape, sides.gain, strict=True)
    ]
    targets = local_shapes.select(masked, sides.shape, sides.gain)
    return gltf.Surface(triangles, normals, names, sides.gain, targets)


def _positions(
    character: rig.Rig, masked: local_shapes.LocalShapes, motion: gltf.Motion
) -> Iterator[np.ndarray]:
    """Yield the (V, 3) float32 positions of every frame."""
    blocks = compose.blocks(masked)
    for frame in range(len(motion.weights)):
        if frame % CHUNK == 0:
            rows = motion.weights[frame : frame + CHUNK]
            shapes = compose.compose(character.neutral, blocks, rows)
        shape = shapes[frame % CHUNK]
        rotation = head_transform.rotation_matrix(motion.rotation[frame])
        yield head_transform.apply(
            shape, rotation, motion.translation[frame], motion.scale[frame], character.pivot
        ).astype(np.float32)


def _form(character: rig.Rig, masked: local_shapes.LocalShapes, motion: gltf.Motion) -> dict:
    """Return what the JSON says of the character."""
    active = (motion.weights != 0) & local_shapes.touched(masked)
    return {
        "axes": {"up": character.up_axis, "R": "x", "G": "y", "B": "z"},
        "unit": character.unit,
        "metres_per_unit": rig.METRES[character.unit],
        "vertex_hash": rig.vertex_hash(character),
        "morph_targets_active_at_once": int(active.sum(axis=1).max()),
    }


def main(argv: Sequence[str]) -> None:
    """Bake frame by frame, so that memory does not grow with the take."""
    options = build_parser().parse_args(argv)
    character = rig.read(options.rig, "mesh")
    played = weights.read(options.weights, character.names)
    masked = local_shapes.masked(character.deltas, character.masks, character.mask_index)
    motion = _motion(character, played)
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
            for positions in _positions(character, masked, motion):
                if not np.isfinite(positions).all():
                    raise errors.InputError(options.weights, "moves vertices beyond float32")
                low = np.minimum(low, positions.min(axis=0))
                high = np.maximum(high, positions.max(axis=0))
                append_exr(positions)
                append_pc2(positions)
                progress.step()
        form = _form(character, masked, motion)
        bounds = np.stack([low, high])
        exr.write_json(paths[1], vertices, frames, first, played.rate, bounds, form)
        sides = morph_sides.split(motion.weights)
        sided = dataclasses.replace(motion, weights=sides.weights)
        gltf.write(paths[3], character, _surface(character, masked, sides), sided)


if __name__ == "__main__":
    cli.run_stage(main)
