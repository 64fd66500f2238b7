"""Try the sync of sounds: `python -m bench.sync_trial --data FOLDER` of GRID, films `*.mpg`.

Pairs of recordings with known offset and drift are spoilt, each by itself, in the ways of
`spoilt_sounds`. Printed, with plain cross-correlation beside:

- sentences: one of 3 s, and pieces of 8 s, sought in films of 36 s, the offset anything up to 30 s
  either way; at 30 s the piece is one end of the film. Then pieces of 15 s that share only 3 to 6 s
- takes: Festival's voice, where it is installed: 10 minutes with a drift of 145 ppm either way,
  offsets of up to 30 s; 80 s, of which 50 are shared, where the drift is only just told
- refusals: sentences of the same speaker with other sentences, other texts of Festival's one voice
  (which repeats its diphones to the sample), silence, noise, hum, and recordings with a piece lost
- files: 44.1 against 48 kHz, through the reader; seconds for 10 minutes against 10 minutes

A plain offset counts as found within 5 ms, at any moment of the take.
"""

import argparse
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import scipy.io.wavfile
import scipy.signal

from bench import festival_voice, spoilt_sounds
from stages.core import audio_sync
from stages.files import sound

RATE, SEED = 8000, 1
FOUND_S = 0.005
FARTHEST_S = 30.0
DRIFT = 145e-6
LONG_S, SHORT_S = 600, 80
WAYS = (
    ("noise10",),
    ("noise0",),
    ("hum",),
    ("hum", "noise0"),
    ("room", "noise10"),
    ("filter", "noise10"),
    ("room", "filter", "noise0"),
    ("hall", "noise10"),
)


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True, help="folder of films with speech")
    folder = parser.parse_args().data
    sentences = [sound.read(path, RATE)[0] for path in sorted(folder.glob("*.mpg"))]
    if len(sentences) < 12:
        sys.stderr.write(f"error: {folder}: expected 12 films *.mpg, found {len(sentences)}\n")
        raise SystemExit(1)
    _say(HEADER)
    _table("3 s in 36 s", _sentence_pairs(sentences, 3))
    _table("8 s in 36 s", _sentence_pairs(sentences, 8))
    _table("3-6 s shared", _shared_pairs(sentences))
    voices = [_voice(number) for number in (1, 2)] if festival_voice.available() else []
    if voices:
        _table("10 min", _long_pairs(voices[0], LONG_S))
        _table("80 s", _long_pairs(voices[0], SHORT_S))
    _refusals(sentences, voices)
    _files(sentences, voices)


HEADER = (
    f"{'':14}{'spoilt by':22}{'pairs':>6}{'refused':>8}{'wrong':>6}{'worst ms':>9}"
    f"{'ppm':>7}{'errors':>7}   {'plain: found':>12}{'worst ms':>10}"
)


def _table(title, pairs):
    """Print a row for every way of spoiling: pairs of mocap, video, offset [s] and drift."""
    for ways in WAYS:
        rng = np.random.default_rng(SEED)
        rows = [_measure(pair, ways, rng) for pair in pairs]
        refused, wrong, error, drift, sigmas, plain = np.array(rows).T
        _say(
            f"{title:14}{' '.join(ways):22}{len(rows):6}{int(refused.sum()):8}"
            f"{int(wrong.sum()):6}{_worst(error, 1e3):>9}{_worst(drift, 1e6):>7}"
            f"{_worst(sigmas, 1):>7}   {int(np.sum(plain < FOUND_S)):12}{plain.max() * 1e3:10.1f}"
        )


def _measure(pair, ways, rng):
    """Return refused, wrong, greatest error over the take [s], of the drift, and plainly [s]."""
    mocap, video, offset, drift = pair
    spoilt = [spoilt_sounds.spoil(one, ways, RATE, rng) for one in (mocap, video)]
    found = audio_sync.synchronise(*spoilt, RATE)
    # the moments that both recordings hold
    ends = np.clip([-offset, len(video) / RATE - offset], 0, len(mocap) / RATE)
    plain = spoilt_sounds.plain_offset(*spoilt, RATE)
    away = np.abs(plain - offset - drift * ends).max()
    if found.reason:
        return 1, 0, np.nan, np.nan, np.nan, away
    error = np.abs((found.drift - drift) * ends + found.offset_s - offset).max()
    told = np.isfinite(found.drift_error)
    wrong = abs(found.drift - drift) if told else np.nan
    return 0, error > FOUND_S, error, wrong, wrong / found.drift_error, away


def _sentence_pairs(sentences, seconds):
    """Return pieces of films of all sentences, in twelve orders; every second one is swapped."""
    rng = np.random.default_rng(SEED)
    pairs = []
    for number in range(len(sentences)):
        order = rng.permutation(len(sentences))
        film = np.concatenate([sentences[k] for k in order])
        last = min(FARTHEST_S, len(film) / RATE - seconds)
        start = round(last * RATE) if number == 0 else int(rng.integers(0, last * RATE))
        piece = film[start : start + seconds * RATE]
        turned = number % 2
        pairs.append((film, piece, -start / RATE, 0) if turned else (piece, film, start / RATE, 0))
    return pairs


def _shared_pairs(sentences):
    """Return pairs of 15 s of which the one ends where the other begins, but for 3 to 6 s."""
    rng = np.random.default_rng(SEED)
    pairs = []
    for _ in sentences:
        whole = np.concatenate([sentences[k] for k in rng.permutation(len(sentences))])
        shared, length = round(rng.uniform(3, 6) * RATE), 15 * RATE
        first, second = whole[:length], whole[length - shared : 2 * length - shared]
        pairs.append((first, second, -(length - shared) / RATE, 0))
    return pairs


def _long_pairs(voice, seconds):
    """Return long takes with drift, the film starting before or after the mocap system."""
    count = seconds * RATE
    pairs = []
    for drift, offset in ((DRIFT, -23.4567), (-DRIFT, FARTHEST_S)):
        video = spoilt_sounds.on_other_clock(voice, drift, offset, count, RATE)
        pairs.append((voice[:count], video, offset, drift))
    return pairs


def _voice(seed):
    """Return over ten minutes of Festival's voice, saying what no other seed makes it say."""
    words = sorted(
        {w.strip(".,?").lower() for line in festival_voice.SENTENCES for w in line.split()}
    )
    draw = random.Random(seed)
    lines = [" ".join(draw.choices(words, k=draw.randint(5, 12))) + "." for _ in range(230)]
    with tempfile.TemporaryDirectory() as folder:
        text, spoken = Path(folder, "text"), Path(folder, "voice.wav")
        text.write_text("\n".join(lines), encoding="utf-8")
        subprocess.run(["text2wave", "-o", str(spoken), str(text)], check=True, timeout=300)
        return sound.read(spoken, RATE)[0]


def _refusals(sentences, voices):
    """Print how many of the pairs that do not belong together are taken to."""
    _say(f"\n{'to be refused':46}{'pairs':>6}{'taken':>6}{'highest confidence':>20}")
    pairs = range(len(sentences))
    others = [(sentences[i], sentences[k]) for i in pairs for k in pairs if i != k]
    for ways in WAYS:
        _refused("other sentences, " + " ".join(ways), others, ways)
    _refused("other sentences, as they are", others, ())
    rng = np.random.default_rng(SEED)
    for seconds, count in ((3, 100), (8, 50), (60, 4), (LONG_S, 1)) if voices else ():
        length, texts = seconds * RATE, []
        for _ in range(count):
            starts = [int(rng.integers(0, len(voice) - length + 1)) for voice in voices]
            cuts = zip(voices, starts, strict=True)
            texts.append([voice[start : start + length] for voice, start in cuts])
        for ways in ((), ("noise10",), ("room", "noise10")):
            name = " ".join(ways) or "as they are"
            _refused(f"other texts of one voice, {seconds} s, {name}", texts, ways)
    silence = np.zeros(len(sentences[0]))
    noise = 0.01 * rng.standard_normal(len(silence))
    hum = spoilt_sounds.spoil(sentences[0], ("hum",), RATE, rng) - sentences[0]
    for name, other, again in (
        ("silence", silence, silence),
        ("noise", noise, 0.01 * rng.standard_normal(len(noise))),
        ("the same hum", hum, hum + 0.01 * noise),
    ):
        _refused(f"{name} with {name}", [(other, again)], ())
        _refused(f"sentences with {name}", [(one, other) for one in sentences], ())
    whole = np.concatenate(sentences)
    for lost in (0.05, 0.5, 5.0):
        cut = np.delete(whole, np.s_[20 * RATE : round((20 + lost) * RATE)])
        _refused(f"36 s of which {lost} s are lost after 20 s", [(whole, cut)], ("noise10",))


def _refused(name, pairs, ways):
    """Print how many pairs were taken to belong together."""
    rng = np.random.default_rng(SEED)
    found = [
        audio_sync.synchronise(*(spoilt_sounds.spoil(one, ways, RATE, rng) for one in pair), RATE)
        for pair in pairs
    ]
    taken = sum(not one.reason for one in found)
    _say(f"{name:46}{len(pairs):6}{taken:6}{max(one.confidence for one in found):20.2f}")


def _files(sentences, voices):
    """Print the error between files of unlike rates, and what ten minutes take."""
    whole = np.concatenate(sentences)
    with tempfile.TemporaryDirectory() as folder:
        read = []
        for rate, cut_s in ((44100, 0.0), (48000, 7.0)):
            finer = scipy.signal.resample_poly(
                whole[round(cut_s * RATE) :], rate // 100, RATE // 100
            )
            path = Path(folder, f"{rate}.wav")
            scipy.io.wavfile.write(path, rate, finer.astype(np.float32))
            read.append(sound.read(path, RATE)[0])
    found = audio_sync.synchronise(*read, RATE)
    _say(f"\n44.1 against 48 kHz, 36 s: off by {abs(found.offset_s + 7) * 1e3:.3f} ms")
    if voices:
        rng = np.random.default_rng(SEED)
        pair = [spoilt_sounds.spoil(voices[0][: LONG_S * RATE], ("noise10",), RATE, rng)] * 2
        start = time.process_time()
        audio_sync.synchronise(*pair, RATE)
        _say(f"10 minutes against 10 minutes: {time.process_time() - start:.1f} s of one core")


def _worst(values, unit):
    """Return the greatest value that is one, in a unit."""
    known = values[np.isfinite(values)]
    return f"{known.max() * unit:.3f}" if len(known) else "-"


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
