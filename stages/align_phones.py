"""Find which phone, and so which viseme, is spoken when, on the clock of the film.

Phones are read from an aligner's TextGrid, mouth shapes from Rhubarb; else the words of a
transcript are placed in the sound, and their phones within them. Known times of words narrow that
down. Times count from the start of the sound; where that is the marker system's, the sync brings
them to the film's clock.
"""

import argparse
from collections.abc import Sequence

import numpy as np

from stages import cli
from stages.core import forced_alignment, word_agreement
from stages.files import (
    errors,
    known_phones,
    phones,
    sound,
    sync,
    transcript,
    visemes,
    word_times,
)

SCHEME = "deng2006"
FLAGS = ("phones", "transcript", "words", "sound", "sync")
BEYOND_S = 0.1
CURE = "give the words that are spoken, or known phones in the column phones"


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the stage's command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    texts = (
        "known phones, .TextGrid, or mouth shapes by Rhubarb, .tsv, .json or .xml",
        "plain text of what is spoken; used where there are no phones",
        "known times of words, .align; used in place of the transcript",
        "the sound in which times count: the film's or the marker system's",
        "how the marker system's time maps to the film's, .json",
    )
    for flag, text in zip(FLAGS, texts, strict=True):
        parser.add_argument(f"--{flag}", nargs="*", default=[], help=f"{text}; none or one")
    parser.add_argument("--visemes", required=True, help="table of phones and visemes, .tsv")
    parser.add_argument("--phones-out", required=True, help="phones to write, .parquet")
    return parser


def main(argv: Sequence[str]) -> None:
    """Read or find the phones, name their visemes, bring them to the film's clock, write them."""
    arguments = build_parser().parse_args(argv)
    for flag in FLAGS:
        if len(getattr(arguments, flag)) > 1:
            raise ValueError(f"--{flag} takes one file, got {len(getattr(arguments, flag))}")
    table = visemes.read(arguments.visemes, SCHEME)
    samples, start_s = None, 0.0
    if arguments.sound:
        samples, start_s = sound.read(arguments.sound[0], forced_alignment.RATE)
    if arguments.phones:
        rows = known_phones.read(arguments.phones[0], table)
        spoken = [row for row in rows if row.phone != visemes.SILENCE]
        _check_within(arguments.phones[0], spoken, samples)
    else:
        rows = _found(arguments, table, samples)
    rows = _on_films_clock(rows, start_s, arguments.sync)
    meta = {"scheme": SCHEME, "origin": "given" if arguments.phones else "found"}
    sources = [path for flag in FLAGS for path in getattr(arguments, flag)]
    phones.write(arguments.phones_out, rows, meta, [*sources, arguments.visemes])


def _check_within(
    path: str, spoken: Sequence[phones.Phone | word_times.Span], samples: np.ndarray | None
) -> None:
    """Refuse what is spoken after the sound's end."""
    if samples is None or not spoken:
        return
    length = len(samples) / forced_alignment.RATE
    if spoken[-1].end_s > length + BEYOND_S:
        message = f"its last sound ends at {spoken[-1].end_s:.2f} s, but the take's sound at"
        raise errors.InputError(path, f"{message} {length:.2f} s: give the file of this take")


def _found(
    arguments: argparse.Namespace, table: dict[str, str], samples: np.ndarray | None
) -> list[phones.Phone]:
    """Find the phones of words in the sound."""
    if not arguments.words and not arguments.transcript:
        message = "the shot has neither phones nor words nor a transcript: see shots.tsv"
        raise errors.InputError(arguments.phones_out, message)
    path = (arguments.words or arguments.transcript)[0]
    if samples is None:
        raise errors.InputError(path, "the shot has no sound to find these words in: see shots.tsv")
    spans = word_times.read(path) if arguments.words else []
    words = [span.word for span in spans] or transcript.read(path)
    if unknown := forced_alignment.unknown_words(words):
        message = f"the dictionary lacks {', '.join(repr(word) for word in unknown)}"
        cure = "spell them as words that sound alike, or give known phones in the column phones"
        raise errors.InputError(path, f"{message}: {cure}")
    _check_within(path, spans, samples)
    try:
        if spans:
            segments = forced_alignment.align_spans(samples, spans)
        else:
            segments = forced_alignment.align(samples, words)
    except forced_alignment.NotAlignedError as error:
        raise errors.InputError(path, f"{error} ({arguments.sound[0]}): {CURE}") from error
    except ValueError as error:
        raise errors.InputError(arguments.sound[0], f"{error}: see shots.tsv") from error
    doubtful = word_agreement.DOUBTFUL_TIMED if spans else word_agreement.DOUBTFUL
    _check_agreement(path, arguments.sound[0], segments, doubtful)
    names = [segment.phone for segment in segments]
    shown = visemes.look_up(path, table, names)
    return [
        phones.Phone(segment.start_s, segment.end_s, name, viseme, segment.word, segment.score)
        for segment, name, viseme in zip(segments, names, shown, strict=True)
    ]


def _check_agreement(
    path: str, heard: str, segments: Sequence[forced_alignment.Segment], doubtful: float
) -> None:
    """Refuse words that are not those spoken; say where they are in doubt."""
    total = word_agreement.agreement(segments)
    if np.isnan(total):
        return
    worst = word_agreement.worst_passage(segments)
    where = f"'{' '.join(worst.words)}' at {worst.start_s:.2f} s"
    if total < word_agreement.OTHER_WORDS:
        message = f"other words are spoken in {heard} (agreement {total:.1f}, worst {where})"
        raise errors.InputError(path, f"{message}: {CURE}")
    if worst.agreement < doubtful:
        message = "%s: words in doubt, %s (agreement %.1f): listen there; see the column score"
        cli.logger.warning(message, path, where, worst.agreement)


def _on_films_clock(
    rows: Sequence[phones.Phone], start_s: float, sync_path: Sequence[str]
) -> list[phones.Phone]:
    """Map times of a sound, which starts at `start_s` on its own clock, to the film's."""
    known = sync.read(sync_path[0]) if sync_path else sync.Sync(0.0, 0.0)
    pace = 1 + known.drift_ppm * 1e-6

    def mapped(time: float) -> float:
        return pace * (time + start_s) + known.offset_s

    return [row._replace(start_s=mapped(row.start_s), end_s=mapped(row.end_s)) for row in rows]


if __name__ == "__main__":
    cli.run_stage(main)
