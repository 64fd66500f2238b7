"""Write a baked take as a folder of numbered OBJ files with the character's own polygons."""

import argparse
from collections.abc import Sequence

from stages import cli
from stages.files import atomic_folder, exr, obj_sequence, rig


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--exr", required=True, help="mesh.exr of the take")
    parser.add_argument("--json", required=True, help="mesh.json of the take")
    parser.add_argument("--rig", required=True, help="rig.npz of the character, a mesh")
    parser.add_argument("--obj-folder", required=True, help="folder to write: frame_0001.obj …")
    return parser


def main(argv: Sequence[str]) -> None:
    """Write a file for every frame, and the clock."""
    options = build_parser().parse_args(argv)
    character = rig.read(options.rig, "mesh")
    description = exr.read_json(options.json)
    exr.check_rig(options.json, description, rig.vertex_hash(character))
    baked = exr.Reader(options.exr, description)
    progress = cli.Progress("export", baked.frames)
    with atomic_folder.replacing(options.obj_folder) as folder:
        write = obj_sequence.writer(folder, character, baked.first_frame + baked.frames - 1)
        for index in range(baked.frames):
            write(baked.first_frame + index, baked.frame(index))
            progress.step()
        clock = baked.first_frame, baked.frames, baked.rate, baked.start
        obj_sequence.write_json(folder / "take.json", character, *clock)


if __name__ == "__main__":
    cli.run_stage(main)
