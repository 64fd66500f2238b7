"""Write a baked take as textures of deviations and normals, for materials of game engines."""

import argparse
import contextlib
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stages import cli
from stages.core import head_transform, polygons, vertex_texture
from stages.files import atomic, errors, exr, rig, texture

PLAIN, OPENVAT = "plain", "openvat"
# rounding of the baked positions and of the mesh's, relative to the largest coordinate
FLOAT32 = 2.0**-23
TALLEST = 16384
LOOKUP = {
    PLAIN: "u = (vertex % width + 0.5) / width,"
    " v = 1 - (frame * blocks + vertex // width + 0.5) / height from the lower left",
    OPENVAT: "u = (vertex % width + 0.5) / width,"
    " v = 1 - (vertex // width * frames + frame + 0.5) / height from the lower left",
}


class Layout(NamedTuple):
    """Hold where frames and vertices stand: `rows[frame, block]` of a picture of this size."""

    width: int
    height: int
    rows: np.ndarray


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--exr", required=True, help="mesh.exr of the take")
    parser.add_argument("--json", required=True, help="mesh.json of the take")
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--layout", required=True, choices=[PLAIN, OPENVAT], help="of the pixels")
    parser.add_argument(
        "--depth", choices=[*texture.TYPES], default="half", help="numbers of the texture"
    )
    parser.add_argument(
        "--scaling",
        choices=[*vertex_texture.SCALINGS],
        default="per_axis",
        help="each axis to 0..1, or all by the greatest deviation to -1..1",
    )
    parser.add_argument("--texture", required=True, help="texture.exr to write: deviations")
    parser.add_argument("--normals", required=True, help="texture_normals.exr to write")
    parser.add_argument("--texture-json", required=True, help="texture.json to write: its layout")
    parser.add_argument(
        "--texture-mesh", required=True, help="texture_mesh.obj to write: what the texture moves"
    )
    return parser


def _layout(options: argparse.Namespace, baked: exr.Reader) -> Layout:
    """Choose width, height and rows."""
    if options.layout == PLAIN:
        width, blocks = exr.layout(baked.vertices)
        height = baked.frames * blocks
    else:
        try:
            width, height = vertex_texture.openvat_size(baked.vertices, baked.frames)
        except ValueError as error:
            message = f"{error}: cut the take, or choose the plain layout"
            raise errors.InputError(options.exr, message) from error
        blocks = -(-baked.vertices // width)
    if height > TALLEST:
        cli.logger.warning("%s is %d high: engines may scale it", options.texture, height)
    frame, block = np.ogrid[: baked.frames, :blocks]
    if options.layout == PLAIN:
        return Layout(width, height, vertex_texture.plain_rows(frame, block, blocks))
    return Layout(width, height, vertex_texture.openvat_rows(frame, block, baked.frames))


def _bounds(baked: exr.Reader, neutral: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return the least and greatest deviation from the neutral (2, 3), in the texture's axes."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for index in range(baked.frames):
        moved = (baked.frame(index) - neutral) @ axes.T
        low, high = np.minimum(low, moved.min(axis=0)), np.maximum(high, moved.max(axis=0))
    return np.stack([low, high])


def _write_pixels(
    paths: Sequence[str],
    depth: str,
    baked: exr.Reader,
    character: rig.Rig,
    layout: Layout,
    scaling: vertex_texture.Scaling,
    axes: np.ndarray,
) -> None:
    """Write both pictures, row by row from the top."""
    triangles = polygons.triangulate(character.sizes, character.corners)
    # beyond the last vertex the index stays on it
    places = np.minimum(np.arange(layout.rows.shape[1] * layout.width), baked.vertices - 1)
    columns = places.reshape(-1, layout.width)
    size = layout.width, layout.height
    progress, shown = cli.Progress("export", layout.rows.size), -1
    with (
        texture.writer(paths[0], *size, depth) as append_pixels,
        texture.writer(paths[1], *size, "half") as append_normals,
    ):
        for place in np.argsort(layout.rows, axis=None):
            frame, block = np.unravel_index(place, layout.rows.shape)
            if frame != shown:
                points = baked.frame(frame)
                pixels = vertex_texture.encode((points - character.neutral) @ axes.T, scaling)
                normals = polygons.vertex_normals(points.astype(float), triangles) @ axes.T
                shown = frame
            append_pixels(pixels[columns[block]])
            append_normals(0.5 * normals[columns[block]] + 0.5)
            progress.step()
        for _ in range(layout.height - layout.rows.size):
            append_pixels(np.zeros((layout.width, 3)))
            append_normals(np.full((layout.width, 3), 0.5))


def _description(
    options: argparse.Namespace,
    baked: exr.Reader,
    character: rig.Rig,
    layout: Layout,
    scaling: vertex_texture.Scaling,
    bounds: np.ndarray,
    largest: float,
) -> dict:
    """Return what the JSON says; `largest` is the largest coordinate [unit]."""
    error = scaling.gain * vertex_texture.ROUNDING[options.depth] + FLOAT32 * largest
    return {
        "layout": options.layout,
        "frames": baked.frames,
        "vertices": baked.vertices,
        "width": layout.width,
        "height": layout.height,
        "blocks": layout.rows.shape[1],
        "fps_num": baked.rate.numerator,
        "fps_den": baked.rate.denominator,
        "first_frame": baked.first_frame,
        **baked.start,
        "axes": {"up": "z" if options.layout == OPENVAT else character.up_axis},
        "unit": character.unit,
        "metres_per_unit": rig.METRES[character.unit],
        "vertex_hash": rig.vertex_hash(character),
        "scaling": {
            "mode": options.scaling,
            "offset": scaling.offset.tolist(),
            "gain": scaling.gain.tolist(),
        },
        "bounds": {"min": bounds[0].tolist(), "max": bounds[1].tolist()},
        "quantisation": {
            "type": options.depth,
            "max_error": error.tolist(),
            "max_distance": float(np.linalg.norm(error)),
        },
        "normals": {"type": "half", "pixel": "normal * 0.5 + 0.5"},
        "lookup": LOOKUP[options.layout],
    }


def main(argv: Sequence[str]) -> None:
    """Find the bounds, then write pictures, mesh and description."""
    options = build_parser().parse_args(argv)
    if options.layout == OPENVAT and options.scaling != "per_axis":
        raise errors.InputError("--scaling", "openvat scales each axis: choose per_axis, or plain")
    character = rig.read(options.rig, "mesh")
    description = exr.read_json(options.json)
    exr.check_rig(options.json, description, rig.vertex_hash(character))
    baked = exr.Reader(options.exr, description)
    layout = _layout(options, baked)
    upright = head_transform.face_axes(character.up_axis).T  # to y up
    openvat = options.layout == OPENVAT
    axes = head_transform.face_axes("z") @ upright if openvat else np.eye(3)
    bounds = _bounds(baked, character.neutral, axes)
    scaling = vertex_texture.SCALINGS[options.scaling](*bounds)
    largest = float(np.abs(character.neutral).max() + np.abs(bounds).max())
    with contextlib.ExitStack() as stack:
        paths = [
            stack.enter_context(atomic.replacing(path))
            for path in (options.texture, options.normals, options.texture_json)
        ]
        mesh_path = stack.enter_context(atomic.replacing(options.texture_mesh))
        _write_pixels(paths[:2], options.depth, baked, character, layout, scaling, axes)
        said = _description(options, baked, character, layout, scaling, bounds, largest)
        remap = {"Min": said["bounds"]["min"], "Max": said["bounds"]["max"]}
        remap |= {"Frames": baked.frames}
        texture.write_json(paths[2], said, remap if openvat else None)
        lookup = vertex_texture.lookup(baked.vertices, layout.width, layout.height, layout.rows[0])
        vertices = character.neutral @ upright.T if openvat else character.neutral
        texture.write_mesh(mesh_path, character, vertices, lookup)


if __name__ == "__main__":
    cli.run_stage(main)
