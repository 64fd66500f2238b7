"""Turn a written sentence, as phones with durations, into mouth parameters over time."""

import numpy as np

FADE_S = 0.07
# the mouth of each kind of sound: what it asks for, and how strongly it insists on it
VISEMES = {
    "m": ({"lip_close": 1.0, "press": 0.35, "jaw_open": 0.06}, 3.0),
    "f": (
        {"jaw_open": 0.07, "lower_down": -0.1, "upper_up": 0.35, "press": 0.25, "stretch": 0.1},
        1.6,
    ),
    "th": ({"jaw_open": 0.14, "tongue_up": 0.75, "lower_down": 0.2}, 0.9),
    "t": ({"jaw_open": 0.10, "tongue_up": 0.8, "stretch": 0.15, "lower_down": 0.2}, 0.7),
    "s": ({"jaw_open": 0.04, "stretch": 0.30, "lower_down": 0.35, "upper_up": 0.2}, 1.1),
    "sh": ({"jaw_open": 0.07, "funnel": 0.75, "pucker": 0.35, "lower_down": 0.2}, 1.3),
    "k": ({"jaw_open": 0.17, "tongue_up": 0.1}, 0.5),
    "r": ({"jaw_open": 0.12, "funnel": 0.45, "pucker": 0.3}, 0.8),
    "l": ({"jaw_open": 0.18, "tongue_up": 0.9}, 0.8),
    "w": ({"jaw_open": 0.08, "pucker": 0.95, "funnel": 0.15}, 1.5),
    "aa": ({"jaw_open": 0.62, "lower_down": 0.15}, 1.0),
    "ae": ({"jaw_open": 0.48, "stretch": 0.40, "upper_up": 0.25, "lower_down": 0.2}, 1.0),
    "eh": ({"jaw_open": 0.32, "stretch": 0.32, "lower_down": 0.2}, 0.9),
    "ee": ({"jaw_open": 0.12, "stretch": 0.75, "lower_down": 0.4, "upper_up": 0.15}, 1.1),
    "ih": ({"jaw_open": 0.18, "stretch": 0.35, "lower_down": 0.2}, 0.8),
    "uh": ({"jaw_open": 0.28, "lower_down": 0.1}, 0.7),
    "oh": ({"jaw_open": 0.36, "funnel": 0.70, "pucker": 0.35}, 1.2),
    "oo": ({"jaw_open": 0.12, "pucker": 0.90, "funnel": 0.35}, 1.3),
    "_": ({}, 0.8),
}
# voiced sounds: first three resonances [Hz] and loudness
VOICE = {
    "m": (280, 1100, 2300, 0.28),
    "th": (320, 1400, 2500, 0.18),
    "r": (380, 1250, 1700, 0.45),
    "l": (360, 1250, 2600, 0.45),
    "w": (310, 750, 2250, 0.40),
    "aa": (820, 1250, 2700, 1.0),
    "ae": (780, 1850, 2650, 0.95),
    "eh": (620, 1950, 2700, 0.85),
    "ee": (310, 2600, 3200, 0.65),
    "ih": (430, 2250, 2900, 0.70),
    "uh": (640, 1300, 2600, 0.80),
    "oh": (520, 950, 2600, 0.90),
    "oo": (340, 950, 2450, 0.65),
}
HISS = {"s": 0.22, "sh": 0.20, "f": 0.07, "t": 0.12, "k": 0.08, "th": 0.05}


def schedule(text, pace=1.0):
    """Return the phones of a written schedule as (name, start, end) [s], all times by a pace."""
    words = text.split()
    result, at = [], 0.0
    for name, length in zip(words[::2], words[1::2], strict=True):
        result.append((name, at, at + pace * float(length)))
        at += pace * float(length)
    return result


def mouth_tracks(phones, times):
    """Return mouth parameters over time: dominance of neighbouring sounds, summed.

    Every sound asks for its mouth with a bell about its middle (Cohen and Massaro's
    dominance); the strength decides who yields, so that lips do close on m, b and p.

    Parameters
    ----------
    phones : list of (name, start, end) [s]
    times : (T,) float array [s]

    Returns
    -------
    tracks : dict name -> (T,) float array
    """
    total = np.full(len(times), 1e-3)
    tracks = {}
    for name, start, end in phones:
        wishes, strength = VISEMES[name]
        middle, half = (start + end) / 2, (end - start) / 2
        beyond = np.maximum(np.abs(times - middle) - 0.7 * half, 0)
        weight = strength * np.exp(-((beyond / FADE_S) ** 2))
        total = total + weight
        for parameter, value in wishes.items():
            tracks[parameter] = tracks.get(parameter, 0) + weight * value
    tracks = {name: track / total for name, track in tracks.items()}
    closed = np.zeros(len(times))
    for name, start, end in phones:
        if name == "m":
            middle, half = (start + end) / 2, (end - start) / 2
            beyond = np.maximum(np.abs(times - middle) - max(half - 0.015, 0.012), 0)
            closed = np.maximum(closed, np.exp(-((beyond / 0.038) ** 2)))
    tracks["lip_close"] = closed
    return tracks
