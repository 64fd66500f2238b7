"""Make the papers' figures on the example show, after its run: `python -m bench.figures`."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import cv2

from bench.figures import (
    example,
    key_shape_figure,
    layer_error_figure,
    layer_mask_figure,
    layer_take,
    layer_timeline_figure,
    lip_figures,
    lip_trial,
    marker_figure,
    own_figure,
    portraits,
    region_frames,
    retarget_figure,
    rig_methods,
)
from stages import cli
from stages.files import errors

REGION = "mouth"
TAKE, BASIS = "talk", "rom"


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--show", required=True, type=Path, help="the example show, after a run")
    parser.add_argument("--figures", required=True, type=Path, help="folder of the pictures")
    return parser


def main(argv: Sequence[str]) -> None:
    """Make figures 4, 5, 6 and 8 of the first paper, 6 of the second, 6, 7 and 8 of the third."""
    cv2.setNumThreads(1)
    arguments = build_parser().parse_args(argv)
    show, folder = arguments.show, arguments.figures
    _check_made(show)
    take, basis = (region_frames.read(show, shot, REGION) for shot in (TAKE, BASIS))
    settings = region_frames.settings(show, REGION)
    own, borrowed = (lip_trial.run(take, source, settings) for source in (take, basis))
    lip_figures.draw_least_squares(own, borrowed, folder / "figure_4.png")
    lip_figures.draw_nonnegative(own, borrowed, settings.solve, folder / "figure_5.png")
    key_shape_figure.draw(show, folder / "figure_6.png")
    retarget_figure.draw(show, folder / "figure_8a.png")
    own_figure.draw(show, folder / "figure_8b.png")
    marker_figure.draw(show, folder / "markers_figure_6.png")
    layer_timeline_figure.draw(show, folder / "layers_figure_6.png")
    layer_mask_figure.draw(show, folder / "layers_figure_7.png")
    layer_error_figure.draw(show, folder / "layers_figure_8.png")


def _check_made(show: Path) -> None:
    """Refuse a show that has not been run."""
    needed = [example.of_actor(show, key_shape_figure.ERRORS)]
    needed += [example.of_shot(show, shot, "key_weights.parquet") for shot in (TAKE, BASIS)]
    needed += [example.of_take(show, TAKE, name, "mesh.json") for name in portraits.CHARACTERS]
    needed += [example.rig(show, rig_methods.CHARACTER, rig_methods.ACTOR)]
    needed += [example.of_shot(show, rig_methods.SHOT, "expression.parquet")]
    needed += layer_take.paths(show)
    shots = (layer_take.SHOT, *layer_error_figure.OTHERS)
    needed += [example.of_shot(show, shot, "expression.parquet") for shot in shots]
    for path in needed:
        if not path.exists():
            raise errors.InputError(path, "is missing: run the example show first, by `make run`")


if __name__ == "__main__":
    cli.run_stage(main)
