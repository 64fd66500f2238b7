"""Write the page that a supervisor opens: every take and shot, from whatever exists.

It is made at the end of each run, whether that succeeded or not, and by hand at any time. What is
missing, or older than a fault, is named with the line in which its stage failed: a failed job
leaves that line in its log until it runs again.
"""

import argparse
import logging
from collections.abc import Sequence
from pathlib import Path

from stages import cli
from stages.files import layer_facts, proposal_table, report_facts, web_page

DELIVERIES = (
    "mesh.glb",
    "mesh.exr",
    "mesh.pc2",
    "mesh.mdd",
    "mesh.usdc",
    "points.usdc",
    "obj/take.json",
    "texture/plain/texture.exr",
    "texture/openvat/texture.exr",
    "blender.py",
    "maya.py",
    "maya.anim",
    "livelink.csv",
    "keys.csv",
    "layers/emotion.csv",
    "layers/speech.csv",
    "layers/blink.csv",
    "delivery.csv",
    "controls.csv",
    "weights.csv",
)
PROPOSALS = 8
# no take waits for these
ASIDE = (
    "propose_labels",
    "propose_expressions",
    "write_brief",
    "check_sculpts",
    "align_phones",
    "select_references",
    "write_references",
    "write_pairs",
    "check_rig",
)

logger = logging.getLogger(__name__)


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", required=True, type=Path, help="folder of the results")
    parser.add_argument("--logs", required=True, type=Path, help="folder of the logs")
    parser.add_argument("--shots", required=True, nargs="*", help="<actor>/<session>/<shot> each")
    parser.add_argument("--basis", required=True, nargs="*", help="names of the basis shots")
    parser.add_argument("--takes", required=True, nargs="*", help="<shot>/<character> each")
    parser.add_argument("--template", required=True, help="template of the page")
    parser.add_argument("--report", required=True, help="page, .html")
    return parser


def main(argv: Sequence[str]) -> None:
    """Gather what exists and write the page."""
    arguments = build_parser().parse_args(argv)
    places = {shot: (actor, session) for actor, session, shot in map(_split, arguments.shots)}
    takes = [_take(arguments, place, places) for place in arguments.takes]
    layered = [
        place
        for place in arguments.takes
        if (arguments.results / "takes" / place / "layers.parquet").is_file()
    ]
    context = {
        "takes": takes,
        "done": sum(not take["failure"] for take in takes),
        "shots": [_shot(arguments, shot, places) for shot in places],
        "asides": _asides(arguments, places),
        "rigs": _rigs(arguments, places),
        "layers": [_layers(arguments.results, place, places) for place in layered],
        "actors": _actors(arguments.results, sorted({actor for actor, _ in places.values()})),
        "proposals": _proposals(arguments.results, sorted({s for _, s in places.values()})),
    }
    web_page.write(arguments.report, arguments.template, context)
    _say(context, arguments.report)


def _say(context: dict, report: str) -> None:
    """Close the run's output with each fault once, and where the page lies."""
    faults = [part["failure"] for part in context["takes"] + context["shots"] if part["failure"]]
    for fault in dict.fromkeys(faults + context["asides"]):
        logger.info("%s", fault)
    done, total = context["done"], len(context["takes"])
    logger.info("%d of %d takes are finished, see %s", done, total, report)


def _split(text: str) -> list[str]:
    """Return the parts of a path of names."""
    return text.split("/")


def _failure(logs: Path, places: Sequence[str], whole: bool) -> str:
    """Return the line in which the first failing stage of some places ended, or nothing."""
    for place in places:
        for log in sorted(logs.glob(f"*/{place}.log")):
            stage = log.relative_to(logs).parts[0]
            fault = "" if stage in ASIDE else _fault(log)
            if fault:
                old = "out of date, made by an earlier run: " if whole else ""
                return f"{old}{stage}: {fault}"
    return "" if whole else "not made yet: run keyface"


def _fault(log: Path) -> str:
    """Return the line in which a failed stage ended, or nothing."""
    for line in log.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("error: "):
            return line.removeprefix("error: ")
    return ""


def _asides(arguments: argparse.Namespace, places: dict) -> list[str]:
    """Return the lines in which stages failed that no take waits for."""
    names = {name for shot, (actor, session) in places.items() for name in (shot, actor, session)}
    names |= {f"{places[shot][0]}/{character}" for shot, character in map(_split, arguments.takes)}
    logs = [arguments.logs / stage / f"{name}.log" for stage in ASIDE for name in sorted(names)]
    faults = {log: _fault(log) for log in logs if log.is_file()}
    return [f"{log.relative_to(arguments.logs).parts[0]}: {f}" for log, f in faults.items() if f]


def _upstream(arguments: argparse.Namespace, shot: str, places: dict) -> list[str]:
    """Return the names of what a shot's weights are made from: sessions, shots, the actor."""
    actor, session = places[shot]
    basis = [name for name in arguments.basis if places[name][0] == actor]
    sessions = [session, *(places[name][1] for name in basis)]
    return list(dict.fromkeys([*sessions, shot, *basis, actor]))


def _take(arguments: argparse.Namespace, place: str, places: dict) -> dict:
    """Return what the page says of a take."""
    shot, character = _split(place)
    folder = arguments.results / "takes" / place
    found = [name for name in DELIVERIES if (folder / name).is_file()]
    preview = (folder / "preview.mp4").is_file()
    whole = preview or "controls.csv" in found
    upstream = [*_upstream(arguments, shot, places), f"{places[shot][0]}/{character}", place]
    return {
        "shot": shot,
        "character": character,
        "preview": f"../takes/{place}/preview.mp4" if preview else "",
        "files": [{"name": name, "path": f"../takes/{place}/{name}"} for name in found],
        "failure": _failure(arguments.logs, upstream, whole),
    }


def _shot(arguments: argparse.Namespace, shot: str, places: dict) -> dict:
    """Return what the page says of a shot."""
    folder = arguments.results / "shots" / shot
    whole = report_facts.is_whole(folder)
    failure = _failure(arguments.logs, _upstream(arguments, shot, places), whole)
    if failure:
        return {"name": shot, "failure": failure}
    return {"name": shot, "failure": ""} | report_facts.shot(folder)


def _rigs(arguments: argparse.Namespace, places: dict) -> list[dict]:
    """Return what the page says of characters that are rigs of shapes."""
    played = {f"{places[shot][0]}/{character}" for shot, character in map(_split, arguments.takes)}
    found = []
    for place in sorted(played):
        folder = arguments.results / "cast" / place
        # a failed job takes its own table away, and leaves the page of an earlier run
        needed = (folder / "references.parquet", folder / "references" / "index.html")
        whole = all(path.is_file() for path in needed)
        if whole or (folder / "rig_checks.tsv").is_file():
            page = f"../cast/{place}/references/index.html" if whole else ""
            actor, character = _split(place)
            found.append(
                {"actor": actor, "character": character, "page": page} | report_facts.rig(folder)
            )
    return found


def _layers(results: Path, place: str, places: dict) -> dict:
    """Return what the page says of the layers of a take."""
    shot, character = _split(place)
    cast = results / "cast" / places[shot][0] / character
    shared = layer_facts.extremes(cast) if (cast / "simplices.tsv").is_file() else "-"
    facts = {"shot": shot, "character": character, "extremes": shared}
    return facts | layer_facts.take(results / "takes" / place)


def _actors(results: Path, actors: Sequence[str]) -> list[dict]:
    """Return the pages of each actor that exist."""
    pages = ("brief", "expressions")
    return [
        {"name": actor}
        | {
            page: f"../{place}" if (results / place).is_file() else ""
            for page, place in ((p, f"actors/{actor}/{p}/index.html") for p in pages)
        }
        for actor in actors
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
