"""Tune pairs as animators do: frames of the performance, and the weights that fit them."""

import numpy as np

from data_example.generator import clay_shapes, cues, marker_cues, marker_takes, shots, spoken

# what an animator's slider is off [1]; below the least a slider stays where it is
TUNING = 0.03
LEAST = 0.025
# Deng's table 1: phones that look alike
VISEMES = (
    "pau", "b p m", "k g ng", "ae ax ah aa", "f v", "ch sh jh", "ao y iy ih ay aw", "ow oy",
    "n d t l", "ey eh el em en er", "th dh", "s z zh", "r", "w uw uh", "hh",
)  # fmt: skip
NEUTRAL = 24


def performance(shot):
    """Return the expressions of a shot's performance, (T, N), and its rate [Hz].

    Its clock starts with the film's first picture, or with the first marker frame without a film.
    """
    if shot in shots.TAKES:
        return shots.TAKES[shot]().expression, shots.RATE
    take = marker_takes.TAKES[shot]()
    rate = marker_takes.RATE
    count = round(take.duration_s * rate) or take.frames
    return marker_takes.expression(take, np.arange(count) / rate), rate


def viseme_frames():
    """Return the middle frame of a phone for every viseme that each sentence has."""
    take, frames = marker_takes.capture(), [NEUTRAL]
    said = spoken.phones()
    for name, start in marker_cues.SENTENCES.items():
        phones = spoken.moved(said[name], start)
        for group in VISEMES:
            alike = [p for p in phones if p.name in group.split()]
            if alike:
                longest = max(alike, key=lambda p: p.end - p.start)
                frames.append(round((longest.start + longest.end) / 2 * marker_takes.RATE))
    spoilt = _spoilt(take)
    return [frame for frame in dict.fromkeys(frames) if not spoilt[frame]]


def extreme_frames():
    """Return the frames on which the range of motion holds its poses."""
    take = marker_takes.capture()
    spoilt = _spoilt(take)
    frames = []
    for notes in take.cues.strip().splitlines():
        start, rise, hold = (float(v) for v in notes.split()[:3])
        frames.append(round((start + rise + hold / 2) * marker_takes.RATE))
    return [frame for frame in frames if frame < len(spoilt) and not spoilt[frame]]


def _spoilt(take):
    """Return which frames no one tunes, mistracked ones and the last, (T,) bool."""
    frame = np.arange(round(take.duration_s * marker_takes.RATE))
    at = frame - take.offset_s * marker_takes.RATE
    # the performance ends with the film's last picture
    result = frame > len(frame) - 8
    for _, _, first, count, _ in marker_takes.faults(take):
        result |= (at > first - 3) & (at < first + count + 3)
    return result


def _spread(weights, chosen, count, allowed):
    """Return frames that lie farthest from those before them, until there are `count`."""
    chosen = list(chosen)
    distance = np.full(len(weights), np.inf)
    for frame in chosen:
        distance = np.minimum(distance, np.linalg.norm(weights - weights[frame], axis=1))
    while len(chosen) < count:
        frame = int(np.argmax(np.where(allowed, distance, -1)))
        chosen.append(frame)
        distance = np.minimum(distance, np.linalg.norm(weights - weights[frame], axis=1))
    return sorted(chosen)


def tuned(weights, rng):
    """Return true weights as an animator leaves the sliders, rounded to hundredths."""
    off = weights + TUNING * rng.standard_normal(weights.shape)
    return np.round(np.clip(np.where(weights < LEAST, 0, off), 0, 1), 2)


def frames_of():
    """Return the shot and frames of every animator, name -> (shot, list of frames)."""
    table, _ = performance("capture")
    weights = clay_shapes.weights(table)
    clean = ~_spoilt(marker_takes.capture())
    anna = _spread(weights, viseme_frames()[:60], 60, clean)
    ben = [frame for frame in extreme_frames() if frame not in anna]
    both = _spread(weights, [*anna, *ben], 100, clean)
    ben = [frame for frame in both if frame not in anna]
    film, _ = performance("rom")
    on_film = clay_shapes.weights(film)
    peaks = [4]
    for notes in cues.ROM.strip().splitlines():
        first, rise, hold = (int(v) for v in notes.split()[:3])
        peaks.append(first + rise + hold // 2)
    rest = _spread(on_film, peaks, 36, np.ones(len(film), bool))
    return {"anna": ("capture", anna), "anna_film": ("rom", rest), "ben": ("capture", ben)}


def by_animator(seed=91):
    """Return the rows of each animator's table of pairs, name -> list of rows of cells."""
    result = {}
    for number, (animator, (shot, frames)) in enumerate(frames_of().items()):
        rng = np.random.default_rng([seed, number])
        weights = clay_shapes.weights(performance(shot)[0])[frames]
        rows = tuned(weights, rng)
        result[animator] = [
            (shot, str(frame), *("" if v == 0 else f"{v:.2f}".rstrip("0").rstrip(".") for v in row))
            for frame, row in zip(frames, rows, strict=True)
        ]
    return result
