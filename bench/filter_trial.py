"""Try the motion filter on a recorded track with jitter of known size: `--data FOLDER`.

`python -m bench.filter_trial --data FOLDER`, the folder as in `rig_take`. The track comes at 30
frames/s. It is cleaned (rows dropped by the recorder are filled by the curve, weights cut to 0..1)
and brought to 60 and 120 frames/s by a monotone cubic, which keeps the depth of every blink and
what the recording holds above 10 Hz; in a second of open mouth now and then, all that moves lips
is brought to rest for a bilabial (80 ms closing, 60 held, 80 opening). White jitter above 10 Hz is
added to every weight. Printed for each filter:

- jitter: power above 10 Hz of what is wrong with the curves, against that of the jitter, over all
  channels, the two blink channels, and those that move lips: by how much it is down
- blinks, closures: how much of the height is left where the truth has its peak, at that very frame,
  over blinks of the two eyes and closures of the character's lips, each the mean of four draws of
  jitter; their mean, the tenth worst in a hundred, and the share of at least 0.95. What jitter is
  left spreads them: see the first row
- lag of the curves against the truth, from the peak of the cross-correlation of their differences
- error: RMS over all channels

Moving average and One-Euro have the settings of least error on this very track; their error is the
best that they can do.
"""

import argparse
import csv
import sys
import time
from pathlib import Path

import numpy as np
import scipy.interpolate
import scipy.signal

from bench import rig_take
from stages.core import kept_moments, motion_filter

RATES = (60, 120)
JITTER, CUTOFF, DRAWS, SEED = 0.02, 10.0, 4, 1
MARKER_NOISE_MM = 0.3
UPPER_LIP, LOWER_LIP = 62, 66  # of the 68 landmarks
BLINK, CLOSURE_MM = 0.3, 5.0
OPEN_MM, APART_S = 8.0, 1.0
CLOSING_S, HELD_S = 0.08, 0.06


def main() -> None:
    """Print a table for each rate, and the time that a large rig takes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", required=True, help="folder of the two rigs and the track")
    folder = parser.parse_args().data
    for rate in RATES:
        _trial(folder, rate)
    values = np.random.default_rng(SEED).uniform(size=(36_000, 946))
    for label, events in (("no events", np.zeros), ("all of it events", np.ones)):
        kept = events(values.shape)
        start = time.process_time()
        motion_filter.filtered(values, 120.0, np.full(946, CUTOFF), kept)
        taken = time.process_time() - start
        _say(f"946 channels, 36,000 frames, {label}: {taken:.1f} s of one processor")


def _trial(folder, rate):
    """Print the figures at one rate."""
    names, truth = clean_track(folder, rate)
    opening = rig_take.opening_of(rig_take.character(folder, names), names)
    kinds = np.array(kept_moments.kinds(names, [""] * len(names)))
    lips, blinks = kinds == kept_moments.CLOSURE, kinds == kept_moments.BLINK
    truth = with_bilabials(truth, truth @ opening, lips, rate)
    curves = [np.eye(len(names))[channel] for channel in np.flatnonzero(blinks)]
    peaks = [(blink, *_fast_peaks(truth @ blink, rate, BLINK)) for blink in curves]
    shut = (-opening, *_fast_peaks(truth @ -opening, rate, CLOSURE_MM))
    actor = rig_take.actor(folder, names)
    made = {}
    for draw in range(DRAWS):
        rng = np.random.default_rng(SEED + draw)
        jitter = _above(rng.standard_normal(truth.shape), rate)
        jitter *= JITTER / jitter.std()
        gap = _marker_gap(actor, truth, rng)
        for label, filtered in _filters(truth + jitter, truth, names, rate, gap):
            wrong = _power(filtered - truth, rate) / _power(jitter, rate)
            down = [1 - wrong[chosen].mean() for chosen in (slice(None), blinks, lips)]
            eyes = np.concatenate([_kept(*peak, truth, filtered) for peak in peaks])
            rest = [1000 * _lag(filtered, truth) / rate, np.std(filtered - truth)]
            figures = (down, eyes, _kept(*shut, truth, filtered), rest)
            made.setdefault(label, []).append(figures)
    of_blinks, of_lips = sum(len(peak[1]) for peak in peaks), len(shut[1])
    _say(f"\n{rate} frames/s, {len(truth)} frames, {of_blinks} blinks, {of_lips} lip closures")
    _say(f"{'':39}jitter down:           blinks:                closures:             lag    error")
    _say(f"{'':39}all    blink  lips     mean  tenth  >=.95    mean  tenth  >=.95   ms")
    for label, draws in made.items():
        down, eyes, closures, rest = (np.mean(part, axis=0) for part in zip(*draws, strict=True))
        parts = [down, _figures(eyes), _figures(closures)]
        cells = " ".join("".join(f"{value:7.3f}" for value in part) for part in parts)
        _say(f"{label:36}{cells}{rest[0]:9.2f}{rest[1]:9.4f}")


def _figures(kept):
    """Return mean, tenth worst in a hundred, and the share that counts as kept."""
    return kept.mean(), np.quantile(kept, 0.1), np.mean(kept >= 0.95)


def clean_track(folder, rate):
    """Return the channels' names and the cleaned track at a rate."""
    names, track = rig_take.track(folder)
    recorded = _times(folder)
    curve = scipy.interpolate.PchipInterpolator(recorded, np.clip(track, 0, 1))
    return names, curve(np.arange(int(recorded[-1] * rate) + 1) / rate)


def _times(folder):
    """Return the times of the track's rows [s]; its timecode counts sixtieths."""
    with (Path(folder) / rig_take.TRACK).open(encoding="utf-8", newline="") as stream:
        codes = [row[0].split(":") for row in list(csv.reader(stream))[1:] if row]
    parts = np.array(codes, float)
    seconds = parts @ [3600, 60, 1, 1 / 60]
    return seconds - seconds[0]


def with_bilabials(track, gap, lips, rate):
    """Return a track with lip closures planted where the mouth is open."""
    reach = HELD_S / 2 + CLOSING_S
    seconds = np.arange(-round(reach * rate), round(reach * rate) + 1) / rate
    ramp = np.clip((np.abs(seconds) - HELD_S / 2) / CLOSING_S, 0, 1)
    shut = 0.5 + 0.5 * np.cos(np.pi * ramp)
    made, last = track.copy(), -np.inf
    for frame in np.flatnonzero(gap > OPEN_MM):
        around = slice(frame - len(seconds) // 2, frame + len(seconds) // 2 + 1)
        if frame - last > APART_S * rate and around.start >= 0 and around.stop <= len(track):
            made[around, lips] *= 1 - shut[:, None]
            last = frame
    return made


def _filters(noisy, truth, names, rate, gap):
    """Yield the name of every filter and what it makes of the curves."""
    yield "none", noisy
    yield _best("moving average", [_averaged(noisy, n) for n in range(3, 16, 2)], truth)
    grid = [(low, beta) for low in (0.5, 1, 2, 4) for beta in (1, 3, 10, 30)]
    yield _best("One-Euro", [_one_euro(noisy, rate, *setting) for setting in grid], truth)
    cutoff, blank = np.full(len(names), CUTOFF), [""] * len(names)
    none = np.zeros(noisy.shape)
    yield "multiresolution", motion_filter.filtered(noisy, rate, cutoff, none)
    for label, seen in (("events", None), ("events, lip points", gap)):
        events = kept_moments.find(noisy, names, blank, rate, seen)
        made = motion_filter.filtered(noisy, rate, cutoff, events)
        yield f"multiresolution, {label}", made


def _best(name, made, truth):
    """Return a filter's name and its curves of least error among several settings."""
    return name, min(made, key=lambda curves: np.sum((curves - truth) ** 2))


def _averaged(values, width):
    """Return the centred moving average."""
    padded = np.pad(values, ((width // 2,) * 2, (0, 0)), mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, width, axis=0).mean(axis=-1)


def _one_euro(values, rate, low, beta):
    """Return the One-Euro filter (Casiez et al. 2012) of every curve, derivative cut-off 1 Hz."""
    made, speed = values.copy(), np.zeros(values.shape[1])
    for frame in range(1, len(values)):
        change = (values[frame] - made[frame - 1]) * rate
        speed = speed + _share(1.0, rate) * (change - speed)
        share = _share(low + beta * np.abs(speed), rate)
        made[frame] = made[frame - 1] + share * (values[frame] - made[frame - 1])
    return made


def _share(cutoff, rate):
    """Return how much of a change a low-pass of first order lets through in a frame."""
    return 1 / (1 + rate / (2 * np.pi * cutoff))


def _marker_gap(actor, truth, rng):
    """Return the distance of the actor's lip markers with their noise [mm]."""
    apart = actor.neutral[UPPER_LIP] - actor.neutral[LOWER_LIP]
    moved = truth @ (actor.deltas[:, UPPER_LIP] - actor.deltas[:, LOWER_LIP])
    noise = MARKER_NOISE_MM * np.sqrt(2) * rng.standard_normal(moved.shape)
    return np.linalg.norm(apart + moved + noise, axis=1)


def _fast_peaks(curve, rate, height):
    """Return frames and heights of the excursions of less than 0.4 s at half their height."""
    frames, found = scipy.signal.find_peaks(curve, prominence=height, width=(0, 0.4 * rate))
    return frames, found["prominences"]


def _kept(channels, frames, heights, truth, filtered):
    """Return how much of its height each peak of some channels' sum keeps."""
    return 1 - (truth[frames] - filtered[frames]) @ channels / heights


def _above(values, rate):
    """Return what curves hold above the cut-off."""
    spectrum = np.fft.rfft(values, axis=0)
    spectrum[np.fft.rfftfreq(len(values), 1 / rate) <= CUTOFF] = 0
    return np.fft.irfft(spectrum, len(values), axis=0)


def _power(values, rate):
    """Return the power of each curve above the cut-off."""
    return np.mean(_above(values, rate) ** 2, axis=0)


def _lag(filtered, truth):
    """Return by how many frames curves come late."""
    one, other = np.diff(filtered, axis=0), np.diff(truth, axis=0)
    reach, count = 15, len(one)
    shifts = np.arange(-reach, reach + 1)
    inner = slice(reach, count - reach)
    score = [np.sum(one[inner] * other[reach - s : count - reach - s]) for s in shifts]
    top = int(np.clip(np.argmax(score), 1, len(shifts) - 2))
    before, at, after = score[top - 1 : top + 2]
    return shifts[top] + 0.5 * (before - after) / (before - 2 * at + after)


def _say(line):
    """Print a line."""
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main()
