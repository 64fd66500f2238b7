"""Write the brief of an actor: one page from which an artist sculpts every key shape.

Each key shape has its picture from the film, its outline against the neutral, why it was chosen,
and for each character the name under which the sculpt is expected and its state. The rows that
lock these key shapes lie beside the page, ready to copy.
"""

import argparse
from collections.abc import Iterable, Sequence

import numpy as np

from stages import cli
from stages.files import (
    atomic,
    face_pictures,
    key_shapes,
    lock_table,
    outline,
    point_set,
    regions,
    sculpt_states,
    series,
    web_page,
)


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--actor", required=True, help="name of the actor")
    parser.add_argument("--key-shapes", required=True, help="key shapes of the actor, .parquet")
    parser.add_argument("--key-shape-table", required=True, help="table of locks and bans")
    parser.add_argument("--errors", required=True, help="error against count, .parquet")
    parser.add_argument("--shots", required=True, nargs="+", help="names of the basis shots")
    parser.add_argument("--videos", required=True, nargs="+", help="their films")
    parser.add_argument(
        "--tracked", required=True, nargs="+", help="their tracked points, .parquet"
    )
    parser.add_argument("--expressions", required=True, nargs="+", help="their expressions")
    parser.add_argument("--point-set", required=True, help="table of contours")
    parser.add_argument("--regions", required=True, help="table of regions")
    parser.add_argument("--characters", required=True, nargs="*", help="characters of the actor")
    parser.add_argument("--states", required=True, nargs="*", help="their sculpts, .parquet")
    parser.add_argument("--template", required=True, help="template of the page")
    parser.add_argument("--page", required=True, help="the brief, .html")
    parser.add_argument("--locks", required=True, help="rows that lock the key shapes, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Gather pictures, outlines and states; write the page and the lock table."""
    arguments = build_parser().parse_args(argv)
    shapes = key_shapes.read(arguments.key_shapes)
    pictures = _pictures(arguments, shapes)
    states = {
        character: {(row["region"], row["key_shape"]): row for row in sculpt_states.read(path)}
        for character, path in zip(arguments.characters, arguments.states, strict=True)
    }
    rows = [(shape.region, shape.shot, shape.frame) for shape in shapes]
    locks = lock_table.locking(arguments.key_shape_table, arguments.actor, rows)
    context = {
        "actor": arguments.actor,
        "characters": [_summary(name, rows.values()) for name, rows in states.items()],
        "regions": _regions(arguments, shapes, pictures, states),
        "lock_table": locks,
    }
    with atomic.replacing(arguments.locks) as temporary:
        temporary.write_text(locks, encoding="utf-8")
    web_page.write(arguments.page, arguments.template, context)


def _summary(name: str, rows: Iterable[dict]) -> dict:
    """Count the states of a character's sculpts."""
    states = [row["state"] for row in rows if row["state"] != "unused"]
    return {"name": name, "total": len(states)} | {
        "present": len(states) - states.count("missing"),
        "suspicious": states.count("suspicious"),
    }


def _pictures(
    arguments: argparse.Namespace, shapes: Sequence[key_shapes.KeyShape]
) -> dict[tuple[str, int], str]:
    """Return the face on the film at every key shape, as the source of an image."""
    found = {}
    sources = zip(arguments.shots, arguments.videos, arguments.tracked, strict=True)
    for shot, video, tracked in sources:
        frames = sorted({shape.frame for shape in shapes if shape.shot == shot})
        if frames:
            faces = face_pictures.cut_out(video, tracked, frames)
            found |= {(shot, frame): web_page.picture(face) for frame, face in faces.items()}
    return found


def _regions(
    arguments: argparse.Namespace,
    shapes: Sequence[key_shapes.KeyShape],
    pictures: dict[tuple[str, int], str],
    states: dict[str, dict],
) -> list[dict]:
    """Return what the page shows of every region."""
    names, neutral, points = _points(arguments)
    contours = point_set.read(arguments.point_set)
    table = regions.read(arguments.regions)
    curves = key_shapes.read_errors(arguments.errors)
    shown = []
    for region in dict.fromkeys(shape.region for shape in shapes):
        chosen, _ = regions.select(arguments.regions, table, region, names)
        parts = outline.rows_by_contour(names, chosen, contours)
        own = [shape for shape in shapes if shape.region == region]
        places = [points[shape.shot][shape.frame] for shape in own]
        cards = [
            _card(shape, outline.paths(place, parts), pictures, states)
            for shape, place in zip(own, places, strict=True)
        ]
        shown.append(
            {
                "name": region,
                "count_reason": own[0].count_reason,
                "shapes": cards,
                "neutral_paths": outline.paths(neutral, parts),
                **outline.window(np.concatenate([neutral[chosen], *(p[chosen] for p in places)])),
                **_error_table([row for row in curves if row["region"] == region]),
            }
        )
    return shown


def _points(
    arguments: argparse.Namespace,
) -> tuple[list[str], np.ndarray, dict[str, np.ndarray]]:
    """Return the names of the P points, the neutral (P, 2) and each shot's (T, P, 2) points."""
    points = {}
    for shot, path in zip(arguments.shots, arguments.expressions, strict=True):
        expression = series.read(path, "expression")
        names, neutral = expression.meta["points"], expression.meta["neutral"]
        points[shot] = series.stack(expression, path, names)
    return names, np.array(neutral), points


def _card(
    shape: key_shapes.KeyShape,
    paths: list[str],
    pictures: dict[tuple[str, int], str],
    states: dict[str, dict],
) -> dict:
    """Return what the page shows of a key shape."""
    rows = {name: found.get((shape.region, shape.key_shape)) for name, found in states.items()}
    return {
        "name": shape.key_shape,
        "shot": shape.shot,
        "frame": shape.frame,
        "reason": shape.reason,
        "locked": shape.locked,
        "paths": paths,
        "picture": pictures[shape.shot, shape.frame],
        "sculpts": [row | {"character": name} for name, row in rows.items() if row],
    }


def _error_table(rows: Sequence[dict]) -> dict:
    """Return the errors of every method and split, a column for each count."""
    counts = sorted({row["count"] for row in rows})
    table: dict[tuple[str, str], dict[int, float]] = {}
    for row in rows:
        table.setdefault((row["method"], row["split"]), {})[row["count"]] = row["rms"]
    lines = [
        {
            "method": method.replace("_", " "),
            "split": split.replace("_", " "),
            "cells": [f"{100 * cells[count]:.2f}" if count in cells else "" for count in counts],
        }
        for (method, split), cells in table.items()
    ]
    return {"counts": counts, "errors": lines}


if __name__ == "__main__":
    cli.run_stage(main)
