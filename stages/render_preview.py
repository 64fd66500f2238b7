"""Render what a take looks like: the film or the markers beside the moving character."""

import argparse
from collections.abc import Callable, Sequence

import cv2
import numpy as np

from stages import cli
from stages.core import head_transform, polygons, portrait, preview
from stages.files import errors, exr, rig, take_source, tempo_text

# the camera is fixed by so many frames of the take, without this share at either end
SAMPLED_FRAMES = 100
STRAY = 0.02


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--video", required=True, help="the shot's film, or empty")
    parser.add_argument("--tracked", nargs="*", default=[], help="tracked.parquet, if it is shown")
    parser.add_argument(
        "--performance", nargs="*", default=[], help="performance.parquet, if markers are shown"
    )
    parser.add_argument("--curves", nargs="*", default=[], help="curves.parquet, if they are shown")
    parser.add_argument("--point-set", required=True, help="table of contours")
    parser.add_argument("--regions", required=True, help="table of regions; each has a colour")
    parser.add_argument("--exr", required=True, help="mesh.exr of the take")
    parser.add_argument("--json", required=True, help="mesh.json of the take")
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--shot", required=True, help="name of the shot, for the caption")
    parser.add_argument("--character", required=True, help="its name, for the caption")
    parser.add_argument(
        "--tempo", default="1", help="how many seconds of the performance pass in one of the take"
    )
    parser.add_argument("--preview", required=True, help="preview.mp4 to write")
    return parser


def _usual_bounds(baked: exr.Reader) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of the box that the character stays in, but for a stray frame or two."""
    rows = np.unique(np.linspace(0, baked.frames - 1, SAMPLED_FRAMES).astype(int))
    corners = [(frame.min(axis=0), frame.max(axis=0)) for frame in map(baked.frame, rows)]
    low, high = np.transpose(corners, (1, 0, 2))
    return np.quantile(low, STRAY, axis=0), np.quantile(high, 1 - STRAY, axis=0)


def _painter(character: rig.Rig, baked: exr.Reader) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function that draws the (V, 3) positions of a character from a fixed camera."""
    return portrait.painter(
        character.neutral,
        polygons.triangulate(character.sizes, character.corners),
        character.colours,
        head_transform.face_axes(character.up_axis),
        _usual_bounds(baked),
        preview.HEIGHT,
    )


def main(argv: Sequence[str]) -> None:
    """Render picture by picture."""
    cv2.setNumThreads(1)
    options = build_parser().parse_args(argv)
    tempo = tempo_text.read("--tempo", options.tempo)
    source = take_source.read(
        options.video,
        options.tracked,
        options.performance,
        options.curves,
        options.point_set,
        options.regions,
    )
    character = rig.read(options.rig, "mesh")
    description = exr.read_json(options.json)
    if description["vertex_hash"] != rig.vertex_hash(character):
        raise errors.InputError(options.json, f"is not baked from {options.rig}: bake again")
    baked = exr.Reader(options.exr, description)
    paint = _painter(character, baked)
    progress = cli.Progress("preview", source.count)

    def character_at(time_s: float) -> np.ndarray:
        progress.step()
        return paint(baked.frame(baked.nearest(time_s)))

    title = f"{options.shot}, {options.character}"
    title += f", tempo {options.tempo}" if tempo != 1 else ""
    take_source.write(options.preview, take_source.at_tempo(source, tempo), title, character_at)


if __name__ == "__main__":
    cli.run_stage(main)
