"""Propose frames of an actor that show extremes of emotion, speech and blink, for a person to pick.

Speech: for each viseme the middle of one of its longest phones, the one that looks most like the
others; beside it the one farthest from the neutral. Emotion: in a shot whose expression is the name
of an extreme, the frame farthest from the neutral outside of speech. Blink: frames of usual, half
and least opening of the eyes, in an otherwise calm face. Nothing is decided here: the page shows
the frames, and the table holds rows to copy to expressions.tsv.
"""

import argparse
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stages import cli
from stages.core import expression_proposals
from stages.files import (
    basis_frames,
    delimited,
    errors,
    expressions,
    extremes,
    face_pictures,
    layer_points,
    outline,
    phones,
    visemes,
    web_page,
)

SCHEME = "kholgade2011"
NOTHING = "-"
# the most that blinking eyes keep of their usual opening: contours meet, markers on lids do not
CONTOUR_CLOSED, MARKERS_CLOSED = 0.5, 0.9
DOT = 1 / 110  # of the drawing's side
TITLES = {
    "emotion": "In the shots whose expression is named in shots.tsv: farthest from the neutral, "
    "outside of speech.",
    "speech": "In the middle of a phone of the viseme.",
    "blink": "By how far the eyes are open, in an otherwise calm face.",
}


class _Proposal(NamedTuple):
    """Hold a frame that may show an extreme; the table offers those that come first."""

    layer: str
    name: str
    row: int
    why: str
    first: bool = True


class _Said(NamedTuple):
    """Hold the row of the middle frame of a phone, and its viseme."""

    row: int
    viseme: str
    phone: phones.Phone


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--actor", required=True, help="name of the actor")
    parser.add_argument("--shots", required=True, nargs="+", help="names of the basis shots")
    parser.add_argument("--expressions", required=True, nargs="+", help="their expressions")
    parser.add_argument(
        "--emotions", required=True, nargs="+", help="what is played in each, - for nothing"
    )
    parser.add_argument("--videos", required=True, nargs="+", help="their films, - where none is")
    parser.add_argument("--phone-shots", nargs="*", default=[], help="those whose phones are known")
    parser.add_argument("--phones", nargs="*", default=[], help="their phones, .parquet")
    parser.add_argument("--visemes", required=True, help="table of phones and visemes")
    parser.add_argument("--points", required=True, choices=list(layer_points.KINDS))
    parser.add_argument(
        "--lid-points",
        required=True,
        help="upper,lower: points whose distance shows blinks, or empty for the eyes' contours",
    )
    parser.add_argument("--extremes", required=True, help="table of all extremes")
    parser.add_argument(
        "--min-confidence", required=True, type=float, help="frames below are left out, 0 to 1"
    )
    parser.add_argument("--template", required=True, help="template of the page")
    parser.add_argument("--page", required=True, help="the page, .html")
    parser.add_argument("--table", required=True, help="rows to copy, .tsv")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read what there is, propose, write page and table."""
    arguments = build_parser().parse_args(argv)
    for flag in ("expressions", "emotions", "videos"):
        if len(getattr(arguments, flag)) != len(arguments.shots):
            raise errors.InputError(f"--{flag}", "give one for each shot")
    if len(arguments.phones) != len(arguments.phone_shots):
        raise errors.InputError("--phones", "give one for each of --phone-shots")
    known = extremes.read(arguments.extremes)
    order = {(each.layer, each.name): place for place, each in enumerate(known)}
    frames = basis_frames.read(
        arguments.expressions, arguments.shots, arguments.points, arguments.min_confidence
    )
    said, spoken = _said(arguments, frames)
    proposals = _emotions(arguments, frames, order, spoken)
    proposals += _speech(frames, said) + _blinks(arguments, frames)
    proposals = _distinct(proposals)
    proposals.sort(key=lambda each: order[each.layer, each.name])
    rows = [
        (arguments.actor, each.layer, each.name, frames.shot[each.row], str(frames.frame[each.row]))
        for each in proposals
        if each.first
    ]
    delimited.write(arguments.table, expressions.COLUMNS, rows)
    _write_page(arguments, frames, known, proposals)


def _said(
    arguments: argparse.Namespace, frames: basis_frames.BasisFrames
) -> tuple[list[_Said], np.ndarray]:
    """Return the phones whose middle is eligible, and the frames (T,) on which words are said."""
    table = visemes.read(arguments.visemes, SCHEME)
    found, spoken = [], np.zeros(len(frames.shot), bool)
    for shot, path in zip(arguments.phone_shots, arguments.phones, strict=True):
        if shot not in arguments.shots:
            raise errors.InputError("--phone-shots", f"'{shot}' is none of --shots")
        for phone in phones.read(path):
            viseme = table.get(phone.phone, "")
            row = basis_frames.row_at(frames, shot, (phone.start_s + phone.end_s) / 2)
            if viseme != table[visemes.SILENCE]:
                during = (frames.time_s >= phone.start_s) & (frames.time_s <= phone.end_s)
                spoken |= during & (frames.shot == shot)
            if viseme and frames.eligible[row]:
                found.append(_Said(row, viseme, phone))
    return found, spoken


def _emotions(
    arguments: argparse.Namespace,
    frames: basis_frames.BasisFrames,
    known: dict[tuple[str, str], int],
    spoken: np.ndarray,
) -> list[_Proposal]:
    """Propose a frame for every emotion that a shot is named after, and for none."""
    calm = frames.eligible & ~spoken
    found = []
    row = expression_proposals.nearest(frames.values, calm)
    if row is not None:
        rest = extremes.AT_REST["emotion"]
        found.append(_Proposal("emotion", rest, row, "nearest to the neutral"))
    played = dict.fromkeys(name for name in arguments.emotions if name != NOTHING)
    for name in played:
        if ("emotion", name) not in known:
            cli.logger.info("expression %s is no extreme, nothing is proposed for it", name)
            continue
        shots = [s for s, n in zip(arguments.shots, arguments.emotions, strict=True) if n == name]
        row = expression_proposals.farthest(frames.values, calm & np.isin(frames.shot, shots))
        if row is not None and name != extremes.AT_REST["emotion"]:
            why = f"farthest from the neutral where {name} is played"
            found.append(_Proposal("emotion", name, row, why))
    return found


def _speech(frames: basis_frames.BasisFrames, said: Sequence[_Said]) -> list[_Proposal]:
    """Propose two frames for every viseme: the typical one, and the strongest."""
    if not said:
        return []
    middles = frames.values[[each.row for each in said]]
    share = expression_proposals.told_apart(middles, [each.viseme for each in said])
    middles = middles * np.sqrt(share)
    found = []
    for viseme in dict.fromkeys(each.viseme for each in said):
        own = [place for place, each in enumerate(said) if each.viseme == viseme]
        if viseme == extremes.AT_REST["speech"]:
            calm = expression_proposals.nearest(frames.values, _rows(frames, said, own))
            found.append(_Proposal("speech", viseme, calm, "silence, nearest to the neutral"))
            continue
        lengths = np.array([said[p].phone.end_s - said[p].phone.start_s for p in own])
        typical = own[expression_proposals.typical(middles[own], lengths)]
        count = f"most typical of {len(own)}" if len(own) > 1 else "the only one"
        why = f"{_spoken(said[typical])}, {count}"
        found.append(_Proposal("speech", viseme, said[typical].row, why))
        strong = own[expression_proposals.farthest(middles[own], np.ones(len(own), bool))]
        if strong != typical:
            why = f"{_spoken(said[strong])}, farthest from the neutral"
            found.append(_Proposal("speech", viseme, said[strong].row, why, False))
    return found


def _rows(
    frames: basis_frames.BasisFrames, said: Sequence[_Said], places: Sequence[int]
) -> np.ndarray:
    """Return which frames (T,) are the middles of some phones."""
    chosen = np.zeros(len(frames.shot), bool)
    chosen[[said[place].row for place in places]] = True
    return chosen


def _spoken(said: _Said) -> str:
    """Return which sound is heard on a frame, in words."""
    word = f" of “{said.phone.word}”" if said.phone.word else ""
    return f"“{said.phone.phone}”{word}, {said.phone.end_s - said.phone.start_s:.2f} s"


def _blinks(arguments: argparse.Namespace, frames: basis_frames.BasisFrames) -> list[_Proposal]:
    """Propose frames of open, half open and closed eyes."""
    opening = np.concatenate(
        [
            basis_frames.eye_opening(path, arguments.lid_points, frames.frame[frames.shot == shot])
            for shot, path in zip(arguments.shots, arguments.expressions, strict=True)
        ]
    )
    closed_share = MARKERS_CLOSED if arguments.lid_points else CONTOUR_CLOSED
    found = expression_proposals.blink_frames(opening, frames.values, frames.eligible, closed_share)
    if found is None:
        seen = "no eyes are seen to close" if np.isfinite(opening).any() else "no eyes are seen"
        cli.logger.info("nothing is proposed for blink: %s", seen)
        return []
    usual = opening[found["open"]]
    words = {"open": "as open as usual", "half": "half way", "closed": "closed"}
    return [
        _Proposal("blink", name, row, f"{words[name]}: {opening[row] / usual:.0%} of usual")
        for name, row in found.items()
    ]


def _distinct(proposals: Sequence[_Proposal]) -> list[_Proposal]:
    """Leave out what would give a frame of one layer two names."""
    taken, kept = set(), []
    for each in sorted(proposals, key=lambda each: not each.first):
        if (each.layer, each.row) not in taken:
            taken.add((each.layer, each.row))
            kept.append(each)
    return kept


def _write_page(
    arguments: argparse.Namespace,
    frames: basis_frames.BasisFrames,
    known: Sequence[extremes.Extreme],
    proposals: Sequence[_Proposal],
) -> None:
    """Write the page with a card for each proposal, and the names for which there is none."""
    pictures = _pictures(arguments, frames, proposals)
    paths = dict(zip(arguments.shots, arguments.expressions, strict=True))
    driving = {
        shot: layer_points.read_available(paths[shot], arguments.points)
        for shot in dict.fromkeys(frames.shot[each.row] for each in proposals)
    }
    notes = {(each.layer, each.name): each.note for each in known}
    shown, groups = [], []
    for layer, text in TITLES.items():
        cards = []
        for each in (each for each in proposals if each.layer == layer):
            shot, frame = frames.shot[each.row], int(frames.frame[each.row])
            place = np.flatnonzero(driving[shot].frame == frame)[0]
            neutral = driving[shot].neutrals[0]
            points = neutral + driving[shot].offsets[0][place]
            shown += [points[:, :2], neutral[:, :2]]
            card = {"shot": shot, "frame": frame, "name": each.name, "why": each.why}
            card |= {"first": each.first, "note": notes[layer, each.name]}
            card["picture"] = pictures.get(each.row, "")
            card["dots"] = outline.dots(points, neutral)
            cards.append(card)
        names = {each.name for each in proposals if each.layer == layer}
        lacking = [each.name for each in known if each.layer == layer and each.name not in names]
        groups.append({"title": layer, "text": text, "cards": cards, "lacking": lacking})
    window = outline.window(np.concatenate(shown) if shown else np.array([[-1.0, -1], [1, 1]]))
    side = float(window["view_box"].split()[-1])
    context = window | {"radius": f"{side * DOT:.4f}", "actor": arguments.actor, "groups": groups}
    web_page.write(arguments.page, arguments.template, context)


def _pictures(
    arguments: argparse.Namespace,
    frames: basis_frames.BasisFrames,
    proposals: Sequence[_Proposal],
) -> dict[int, str]:
    """Return the film's picture at every row, as the source of an image."""
    found = {}
    for shot, video in zip(arguments.shots, arguments.videos, strict=True):
        rows = [each.row for each in proposals if frames.shot[each.row] == shot]
        if video != NOTHING and rows:
            images = face_pictures.at_times(video, frames.time_s[rows].tolist())
            found |= {r: web_page.picture(image) for r, image in zip(rows, images, strict=True)}
    return found


if __name__ == "__main__":
    cli.run_stage(main)
