"""Try the search for phones: `python -m bench.phone_trial`, `--data FOLDER` for a folder of GRID.

The folder holds films `*.mpg` and `*.align`. Festival's voice is tried where it is installed.
Printed:

- phones: how far the starts of phones are from Festival's true ones, by sentence and with all
  sentences as one sound of two minutes; phones that the two pronunciations share, silences left
  out; and of the phones inside words, with and without their words' true times
- words: the same for starts of words against GRID's times, which were found by another aligner;
  given those times, they are kept
- words of others: sounds of three sentences or clips, with white noise, are given their own words,
  their own but for one sentence, and those of other sounds (of the same kind, and of both): the
  least and greatest agreement, and how many are refused or flagged
- times of others: the same of GRID's clips with the times of words of other clips
"""

import argparse
import itertools
import sys
from pathlib import Path

import numpy as np

from bench import festival_voice
from stages.core import forced_alignment, word_agreement
from stages.files import sound, word_times

# Festival's phones that the dictionary writes otherwise
SAME = {"ax": "ah", "dx": "t"}
SEED = 1
NOISES_DB = (None, 20, 10)
TOGETHER, OTHERS = 3, 2


def main() -> None:
    """Print the figures that the voice and the data allow."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder of GRID: films .mpg and their .align")
    folder = parser.parse_args().data
    kinds = {}
    if festival_voice.available():
        spoken = festival_voice.speak()
        _phones(spoken)
        kinds["Festival"] = [(sentence.samples, sentence.words) for sentence in spoken]
    else:
        _say("phones: Festival is not installed, left out")
    if folder is not None:
        clips = [_clip(path) for path in sorted(folder.glob("*.align"))]
        _words(clips)
        _times(clips)
        kinds["GRID"] = [(samples, [span.word for span in spans]) for samples, spans in clips]
    groups = []
    for kind, sounds in kinds.items():
        starts = range(0, len(sounds), TOGETHER)
        groups += [(kind, sounds[start : start + TOGETHER]) for start in starts]
    for noise in NOISES_DB:
        _others(groups, noise)


def _clip(path):
    """Return samples and timed words of a clip of GRID."""
    samples, _ = sound.read(path.with_suffix(".mpg"), forced_alignment.RATE)
    return samples, word_times.read(path)


def _phones(spoken):
    """Print the errors of the starts of phones on Festival's voice."""
    found = [forced_alignment.align(sentence.samples, sentence.words) for sentence in spoken]
    errors = [_errors(one, s.phones) for one, s in zip(found, spoken, strict=True)]
    total = sum(name != "pau" for sentence in spoken for *_, name in sentence.phones)
    _show(f"phones, Festival, by sentence, of {total}", itertools.chain(*errors))
    joined = np.concatenate([sentence.samples for sentence in spoken])
    starts = np.cumsum([0] + [len(s.samples) for s in spoken]) / forced_alignment.RATE
    truth = [
        (start + begin, end, name)
        for start, sentence in zip(starts, spoken, strict=False)
        for begin, end, name in sentence.phones
    ]
    words = [word for sentence in spoken for word in sentence.words]
    _show(
        f"phones, Festival, {starts[-1]:.0f} s",
        _errors(forced_alignment.align(joined, words), truth),
    )
    inner = {"words found": [], "words known": []}
    for one, sentence in zip(found, spoken, strict=True):
        spans = sentence.word_spans
        narrowed = forced_alignment.align_spans(sentence.samples, spans)
        edges = {round(start, 4) for start, _, _ in spans}
        inside = [phone for phone in sentence.phones if round(phone[0], 4) not in edges]
        inner["words found"] += _errors(one, inside)
        inner["words known"] += _errors(narrowed, inside)
    for label, values in inner.items():
        _show(f"phones inside words, Festival, {label}", values)


def _words(clips):
    """Print the errors of the starts of words on GRID."""
    errors = []
    for samples, spans in clips:
        found = forced_alignment.align(samples, [span.word for span in spans])
        words = [(word, next(own)) for word, own in itertools.groupby(found, lambda s: s.word)]
        starts = [first.start_s for word, first in words if word]
        errors += [at - span.start_s for at, span in zip(starts, spans, strict=True)]
    _show("words, GRID", errors)


def _times(clips):
    """Print the agreement of clips with their own timed words and with those of others."""
    for label, shift in (("own", 0), ("another clip's", 1), ("another clip's", 5)):
        found = [
            word_agreement.agreement(
                forced_alignment.align_spans(samples, clips[(at + shift) % len(clips)][1])
            )
            for at, (samples, _) in enumerate(clips)
        ]
        flagged = sum(value < word_agreement.DOUBTFUL_TIMED for value in found)
        span = f"{min(found):.2f} to {max(found):.2f}"
        _say(f"timed words, GRID, {label}: agreement {span}, flagged {flagged} of {len(found)}")


def _errors(segments, truth):
    """Return the errors of the starts of the phones that two pronunciations share [s]."""
    found = [segment for segment in segments if segment.word]
    known = [phone for phone in truth if phone[2] != "pau"]
    names = [SAME.get(name, name) for *_, name in known]
    pairs = _shared([segment.phone for segment in found], names)
    return [found[one].start_s - known[other][0] for one, other in pairs]


def _shared(one, other):
    """Return the places of what two sequences share, (i, j), by their least edit distance."""
    costs = np.zeros((len(one) + 1, len(other) + 1))
    costs[:, 0], costs[0] = np.arange(len(one) + 1), np.arange(len(other) + 1)
    for i, j in itertools.product(range(len(one)), range(len(other))):
        same = costs[i, j] + (one[i] != other[j])
        costs[i + 1, j + 1] = min(same, costs[i, j + 1] + 0.7, costs[i + 1, j] + 0.7)
    pairs, i, j = [], len(one), len(other)
    while i and j:
        if costs[i, j] == costs[i - 1, j - 1] + (one[i - 1] != other[j - 1]):
            i, j = i - 1, j - 1
            pairs += [(i, j)] if one[i] == other[j] else []
        elif costs[i, j] == costs[i - 1, j] + 0.7:
            i -= 1
        else:
            j -= 1
    return pairs


def _others(groups, noise):
    """Print what becomes of right and of wrong words at a level of noise."""
    rng = np.random.default_rng(SEED)
    found = {"right words": [], "one sentence of three wrong": [], "other words": []}
    for index, (kind, group) in enumerate(groups):
        samples = _noisy(np.concatenate([samples for samples, _ in group]), noise, rng)
        texts = [words for _, words in group]
        found["right words"].append(_verdict(samples, texts))
        others = [other for at, other in enumerate(groups) if at != index]
        alike = [other for other in others if other[0] == kind]
        for draw in range(OTHERS):
            pool = alike if draw % 2 and alike else others
            strange = [words for _, words in pool[rng.integers(len(pool))][1]]
            found["other words"].append(_verdict(samples, strange))
            if draw == 1:
                mixed = [texts[0], strange[0], *texts[2:]]
                found["one sentence of three wrong"].append(_verdict(samples, mixed))
    _say(f"noise {'none' if noise is None else f'at {noise} dB'}")
    for label, verdicts in found.items():
        _report(label, verdicts)


def _verdict(samples, texts):
    """Return the agreement of words, all and in their worst passage; None where not aligned."""
    try:
        segments = forced_alignment.align(samples, [word for words in texts for word in words])
    except forced_alignment.NotAlignedError:
        return None
    passage = word_agreement.worst_passage(segments)
    return word_agreement.agreement(segments), passage.agreement


def _report(label, verdicts):
    """Print how many words were refused or flagged."""
    placed = np.array([verdict for verdict in verdicts if verdict is not None]).reshape(-1, 2)
    refused = placed[:, 0] < word_agreement.OTHER_WORDS
    flagged = ~refused & (placed[:, 1] < word_agreement.DOUBTFUL)
    lost = len(verdicts) - len(placed)
    spans = [f"{c.min():.2f} to {c.max():.2f}" if len(c) else "none" for c in placed.T]
    _say(
        f"  {label:28} {len(verdicts):3}: not aligned {lost}, refused {refused.sum()}, "
        f"flagged {flagged.sum()}; agreement {spans[0]}, worst passage {spans[1]}"
    )


def _noisy(samples, noise, rng):
    """Return a sound with white noise so many decibels below it."""
    if noise is None:
        return samples
    level = np.sqrt(np.mean(samples**2)) * 10 ** (-noise / 20)
    return samples + level * rng.standard_normal(len(samples)).astype(np.float32)


def _show(label, errors):
    """Print the errors of starts, in milliseconds."""
    values = 1000 * np.array(list(errors))
    sizes = np.abs(values)
    _say(
        f"{label:44} {len(values):4}: mean {sizes.mean():6.2f} ms, median {np.median(sizes):6.2f}, "
        f"95 % within {np.percentile(sizes, 95):6.1f}, bias {np.median(values):+6.2f}"
    )


def _say(line):
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
