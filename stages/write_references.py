"""Write the page from which an animator tunes reference frames, and the table to fill in.

Each frame has the film's picture at that moment, its points against the neutral, and weights to
start from: what the pairs so far predict, or else what the equation solve gives. The table lists
the frames that nobody has tuned.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.files import (
    atomic,
    delimited,
    driving_points,
    face_pictures,
    outline,
    reference_table,
    rig,
    series,
    web_page,
)

TITLES = {
    "viseme": ("Visemes", "The middle of a phone for each viseme and emotion."),
    "extreme": ("Extremes", "The strongest poses of each emotion."),
    "coverage": ("Next", "What teaches most beyond all that is chosen or tuned already."),
}
NO_FILM = "-"
SHOWN_WEIGHTS = 8
LEAST_SHOWN = 0.05
DOT = 1 / 110  # of the drawing's side


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--actor", required=True, help="name of the actor")
    parser.add_argument("--character", required=True, help="name of the character")
    parser.add_argument("--references", required=True, help="the chosen frames, .parquet")
    parser.add_argument("--shots", required=True, nargs="+", help="names of the basis shots")
    parser.add_argument("--expressions", required=True, nargs="+", help="their expressions")
    parser.add_argument("--videos", required=True, nargs="+", help="their films, - where none is")
    parser.add_argument("--points", required=True, choices=list(driving_points.AXES))
    parser.add_argument("--starts", nargs="*", default=[], help="weights to start from, if any")
    parser.add_argument("--rig", required=True, help="rig.npz of the character")
    parser.add_argument("--pair-folder", required=True, help="where tables of pairs are kept")
    parser.add_argument("--template", required=True, help="template of the page")
    parser.add_argument("--page", required=True, help="the page, .html")
    parser.add_argument("--table", required=True, help="rows to tune, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Gather pictures, points and weights; write the page and the table."""
    arguments = build_parser().parse_args(argv)
    rows, header = reference_table.read(arguments.references)
    shapes = [name.partition(".")[2] for name in rig.read_any(arguments.rig).names]
    points = {
        shot: driving_points.read(path, arguments.points)
        for shot, path in zip(arguments.shots, arguments.expressions, strict=True)
    }
    starts = _starts(arguments, rows, shapes)
    with atomic.replacing(arguments.table) as temporary:
        open_rows = [row for row in rows if not row["tuned_by"]]
        temporary.write_text(_table(open_rows, shapes, starts), encoding="utf-8")
    shown = [points[row["shot"]].points[row["frame"], :, :2] for row in rows]
    neutral = points[arguments.shots[0]].neutral[:, :2]
    window = outline.window(np.concatenate([neutral, *shown]))
    side = float(window["view_box"].split()[-1])
    uncovered = header["uncovered"]
    context = window | {
        "actor": arguments.actor,
        "character": arguments.character,
        "pairs": header["pairs"],
        "uncovered": None if uncovered is None else f"{uncovered:.0%}",
        "pair_folder": arguments.pair_folder,
        "start": "weights" if starts else "",
        "radius": f"{side * DOT:.4f}",
        "groups": _groups(rows, _pictures(arguments, rows), points, shapes, starts),
    }
    web_page.write(arguments.page, arguments.template, context)


def _starts(
    arguments: argparse.Namespace, rows: Sequence[dict], shapes: Sequence[str]
) -> dict[tuple[str, int], np.ndarray]:
    """Return the weights to start from, by shot and frame."""
    found = {}
    for shot, path in zip(arguments.shots, arguments.starts, strict=False):
        solved = series.read(path, ("predicted", "solved"))
        values = {name.partition(".")[2]: column for name, column in solved.columns.items()}
        for row in rows:
            if row["shot"] == shot:
                weights = [values[shape][row["frame"]] for shape in shapes]
                found[shot, row["frame"]] = np.nan_to_num(weights)
    return found


def _table(
    rows: Sequence[dict], shapes: Sequence[str], starts: dict[tuple[str, int], np.ndarray]
) -> str:
    """Return the text of the table to fill in: a row for each frame, a column for each shape."""
    lines = []
    for row in rows:
        weights = starts.get((row["shot"], row["frame"]), np.zeros(len(shapes)))
        cells = [f"{weight:.2f}" if abs(weight) >= LEAST_SHOWN else "" for weight in weights]
        lines.append([row["shot"], str(row["frame"]), *cells])
    return delimited.as_text(["shot", "frame", *shapes], lines)


def _pictures(arguments: argparse.Namespace, rows: Sequence[dict]) -> dict[tuple[str, int], str]:
    """Return the film's picture at every frame, as the source of an image."""
    found = {}
    for shot, video in zip(arguments.shots, arguments.videos, strict=True):
        own = [row for row in rows if row["shot"] == shot]
        if video != NO_FILM and own:
            images = face_pictures.at_times(video, [row["time_s"] for row in own])
            for row, image in zip(own, images, strict=True):
                found[shot, row["frame"]] = web_page.picture(image)
    return found


def _groups(
    rows: Sequence[dict],
    pictures: dict[tuple[str, int], str],
    points: dict[str, driving_points.DrivingPoints],
    shapes: Sequence[str],
    starts: dict[tuple[str, int], np.ndarray],
) -> list[dict]:
    """Return the page's cards, one group for each way of choosing."""
    groups = []
    for source, (title, text) in TITLES.items():
        cards = []
        for row in (row for row in rows if row["source"] == source):
            key = row["shot"], row["frame"]
            card = {name: row[name] for name in ("shot", "frame", "tuned_by")}
            card["picture"] = pictures.get(key, "")
            card["reason"] = _reason(row)
            driving = points[row["shot"]]
            card["dots"] = outline.dots(driving.points[row["frame"]], driving.neutral)
            card["weights"] = _weights(shapes, starts.get(key))
            cards.append(card)
        if cards:
            groups.append({"title": title, "text": text, "cards": cards})
    return groups


def _reason(row: dict) -> str:
    """Return why a frame was chosen, in words."""
    words = {"viseme": f"viseme {row['viseme']}", "extreme": "extreme", "coverage": "coverage"}
    parts = [words[row["source"]], row["emotion"], f"{row['time_s']:.2f} s"]
    return ", ".join(part for part in parts if part)


def _weights(shapes: Sequence[str], weights: np.ndarray | None) -> list[dict]:
    """Return the strongest weights to start from."""
    if weights is None:
        return []
    order = np.argsort(-weights, kind="stable")[:SHOWN_WEIGHTS]
    return [
        {
            "name": shapes[k],
            "value": f"{weights[k]:.2f}",
            "share": f"{100 * min(weights[k], 1.0):.0f}",
        }
        for k in order
        if weights[k] >= LEAST_SHOWN
    ]


if __name__ == "__main__":
    cli.run_stage(main)
