"""Write the page that a supervisor opens: every take and shot, from whatever exists.

It is made at the end of each run, whether that succeeded or not, and by hand at any time; what is
missing is named with the line in which its stage failed.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages import cli
from stages.core import head_leak
from stages.files import proposal_table, series, web_page

DELIVERIES = ("mesh.glb", "mesh.exr", "mesh.pc2", "controls.csv", "weights.csv")
MOTION = ("rotation.z", "translation.x", "translation.y", "scale")
PROPOSALS = 8


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", required=True, type=Path, help="folder of the results")
    parser.add_argument("--logs", required=True, type=Path, help="folder of the logs")
    parser.add_argument("--shots", required=True, nargs="*", help="<actor>/<session>/<shot> each")
    parser.add_argument("--takes", required=True, nargs="*", help="<shot>/<character> each")
    parser.add_argument("--template", required=True, help="template of the page")
    parser.add_argument("--report", required=True, help="page, .html")
    return parser


def main(argv: Sequence[str]) -> None:
    """Gather what exists and write the page."""
    arguments = build_parser().parse_args(argv)
    places = {shot: (actor, session) for actor, session, shot in map(_split, arguments.shots)}
    takes = [_take(arguments, place, places) for place in arguments.takes]
    context = {
        "takes": takes,
        "done": sum(not take["failure"] for take in takes),
        "shots": [_shot(arguments, shot, place) for shot, place in places.items()],
        "actors": _actors(arguments.results, sorted({actor for actor, _ in places.values()})),
        "proposals": _proposals(arguments.results, sorted({s for _, s in places.values()})),
    }
    web_page.write(arguments.report, arguments.template, context)


def _split(text: str) -> list[str]:
    """Return the parts of a path of names."""
    return text.split("/")


def _failure(logs: Path, places: Sequence[str]) -> str:
    """Return the line in which the first failing stage of some places ended."""
    for place in places:
        for log in sorted(logs.glob(f"*/{place}.log")):
            for line in log.read_text(encoding="utf-8", errors="replace").splitlines():
                if line.startswith("error: "):
                    return f"{log.relative_to(logs).parts[0]}: {line.removeprefix('error: ')}"
    return "not made yet: run snakemake"


def _take(arguments: argparse.Namespace, place: str, places: dict) -> dict:
    """Return what the page says of a take."""
    shot, character = _split(place)
    actor, session = places[shot]
    folder = arguments.results / "takes" / place
    found = [name for name in DELIVERIES if (folder / name).is_file()]
    preview = (folder / "preview.mp4").is_file()
    whole = preview or "controls.csv" in found
    upstream = [session, shot, actor, f"{actor}/{character}", place]
    return {
        "shot": shot,
        "character": character,
        "preview": f"../takes/{place}/preview.mp4" if preview else "",
        "files": [{"name": name, "path": f"../takes/{place}/{name}"} for name in found],
        "failure": "" if whole else _failure(arguments.logs, upstream),
    }


def _shot(arguments: argparse.Namespace, shot: str, place: tuple[str, str]) -> dict:
    """Return what the page says of a shot."""
    actor, session = place
    folder = arguments.results / "shots" / shot
    files = [folder / f"{name}.parquet" for name in ("expression", "head_motion", "key_weights")]
    if not all(path.is_file() for path in files):
        return {"name": shot, "failure": _failure(arguments.logs, [session, shot, actor])}
    expression, motion, weights = (series.read(path, path.stem) for path in files)
    confidence = np.nan_to_num(expression.columns["confidence"])
    lost = int((confidence == 0).sum())
    return {
        "name": shot,
        "failure": "",
        "frames": len(confidence),
        "strip": _strip(confidence),
        "lost": f"{lost} ({lost / len(confidence):.0%})",
        "leak": _leak(expression, motion),
        "residuals": ", ".join(
            f"{name.removesuffix('.residual')} {np.nanmedian(values):.4f}"
            for name, values in weights.columns.items()
            if name.endswith(".residual") and np.isfinite(values).any()
        ),
    }


def _strip(confidence: np.ndarray) -> str:
    """Return the SVG path of the area below a curve from 0 to 1."""
    steps = "".join(f"V{1 - value:.2f}h1" for value in confidence)
    return f"M0 1{steps}V1Z"


def _leak(expression: series.Series, motion: series.Series) -> str:
    """Return the head leak, with the face's strongest motion as the opening of the jaw."""
    points = np.stack([v for n, v in expression.columns.items() if n.endswith((".x", ".y"))], 1)
    parameters = np.stack([motion.columns[name] for name in MOTION], axis=1)
    opening = head_leak.strongest_motion(points)
    leak = head_leak.head_leak(parameters, opening, round(float(motion.rate)))
    return "-" if np.isnan(leak) else f"{leak:.2f}"


def _actors(results: Path, actors: Sequence[str]) -> list[dict]:
    """Return the actors that have a brief."""
    return [
        {"name": actor, "brief": f"../actors/{actor}/brief/index.html"}
        for actor in actors
        if (results / "actors" / actor / "brief" / "index.html").is_file()
    ]


def _proposals(results: Path, sessions: Sequence[str]) -> list[dict]:
    """Return the first frames of each session that are worth labelling."""
    rows = []
    for session in sessions:
        path = results / "sessions" / session / "label_proposals.tsv"
        if path.is_file():
            read = proposal_table.read(path)[:PROPOSALS]
            rows += [{"session": session} | row for row in read]
    return rows


if __name__ == "__main__":
    cli.run_stage(main)
