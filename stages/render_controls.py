"""Render a take of named controls: the film or the markers beside the moving curves."""

import argparse
from collections.abc import Sequence

import cv2
import numpy as np

from stages import cli
from stages.core import curve_panel, preview
from stages.files import series, take_source, tempo_text


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
    parser.add_argument("--controls", required=True, help="controls.parquet of the take")
    parser.add_argument("--shot", required=True, help="name of the shot, for the caption")
    parser.add_argument("--character", required=True, help="its name, for the caption")
    parser.add_argument(
        "--tempo", default="1", help="how many seconds of the performance pass in one of the take"
    )
    parser.add_argument("--preview", required=True, help="preview.mp4 to write")
    return parser


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
    curves = series.read(options.controls, "controls")
    values = np.stack(list(curves.columns.values()), axis=1)
    shown = curve_panel.liveliest(values)
    names = [list(curves.columns)[column] for column in shown]
    values = values[:, shown]
    lanes = curve_panel.draw_lanes(names, values, preview.HEIGHT)
    progress = cli.Progress("preview", source.count)

    def curves_at(time_s: float) -> np.ndarray:
        progress.step()
        row = int(np.abs(curves.time_s - time_s).argmin())
        return curve_panel.draw_playhead(lanes, values, row)

    title = f"{options.shot}, {options.character}"
    title += f", tempo {options.tempo}" if tempo != 1 else ""
    take_source.write(options.preview, take_source.at_tempo(source, tempo), title, curves_at)


if __name__ == "__main__":
    cli.run_stage(main)
