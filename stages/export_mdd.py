"""Write a baked take as an MDD point cache."""

import argparse
from collections.abc import Sequence

from stages import cli
from stages.files import atomic, exr, mdd


def build_parser() -> argparse.ArgumentParser:
    """Return the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--exr", required=True, help="mesh.exr of the take")
    parser.add_argument("--json", required=True, help="mesh.json of the take")
    parser.add_argument("--mdd", required=True, help="mesh.mdd to write: times in seconds")
    return parser


def main(argv: Sequence[str]) -> None:
    """Copy the positions frame by frame."""
    options = build_parser().parse_args(argv)
    baked = exr.Reader(options.exr, exr.read_json(options.json))
    progress = cli.Progress("export", baked.frames)
    with (
        atomic.replacing(options.mdd) as temporary,
        mdd.writer(temporary, baked.vertices, baked.time_s) as append,
    ):
        for frame in range(baked.frames):
            append(baked.frame(frame))
            progress.step()


if __name__ == "__main__":
    cli.run_stage(main)
