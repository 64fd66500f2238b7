"""Turn phones into coefficients of the twelve visemes: neighbouring sounds share the mouth."""

import numpy as np

from data_example.generator import fields, play_cues, speech

VISEMES = tuple(play_cues.EXTREMES["speech"])
# ARPAbet to visemes, one after the other, each with its share against rest: weak sounds open less
SOUNDS = {
    "b": "m", "p": "m", "m": "m", "f": "f", "v": "f", "th": "th", "dh": "th", "l": "th",
    "t": "t", "d": "t", "n": "t", "s": "t", "z": "t", "k": "t:0.6", "g": "t:0.6", "ng": "t:0.6",
    "sh": "sh", "zh": "sh", "ch": "t sh", "jh": "t sh", "r": "r", "er": "r", "w": "oo",
    "uw": "oo", "uh": "oo:0.8", "ao": "oh", "ow": "oh oo", "oy": "oh ee", "aa": "aa",
    "ah": "aa:0.6", "ax": "aa:0.4", "ay": "aa ee", "aw": "aa oo", "hh": "aa:0.3", "eh": "eh",
    "ae": "eh", "ey": "eh ee", "iy": "ee", "ih": "ee:0.7", "y": "ee", "pau": "rest",
}  # fmt: skip
# how strongly each viseme insists against its neighbours
STRENGTH = dict.fromkeys(VISEMES, 1.0) | {
    "rest": 0.8, "m": 3.0, "f": 1.6, "t": 0.7, "sh": 1.4, "oo": 1.4, "oh": 1.2,
}  # fmt: skip
# lips that close stay closed for a picture at least [s]
CLOSED_S = 0.017


def coefficients(phones, times):
    """Return the share of each viseme in the mouth, (T, 12), rows summing to 1.

    Every sound asks for its viseme with a bell about its middle, as in speech.mouth_tracks; m, b
    and p come through to the full, so that lips do close.
    """
    total = np.zeros((len(times), len(VISEMES)))
    total[:, 0] = 1e-3
    closed = np.zeros(len(times))
    for phone in phones:
        parts = SOUNDS[phone.name].split()
        ends = np.linspace(phone.start, phone.end, len(parts) + 1)
        for part, start, end in zip(parts, ends[:-1], ends[1:], strict=True):
            viseme, _, share = part.partition(":")
            share = float(share or 1)
            middle, half = (start + end) / 2, (end - start) / 2
            off = np.abs(times - middle)
            bell = np.exp(-((np.maximum(off - 0.7 * half, 0) / speech.FADE_S) ** 2))
            total[:, VISEMES.index(viseme)] += STRENGTH[viseme] * share * bell
            total[:, 0] += STRENGTH[viseme] * (1 - share) * bell
            if viseme == "m":
                late = np.maximum(off - max(half - 0.012, CLOSED_S), 0)
                closed = np.maximum(closed, np.exp(-((late / 0.038) ** 2)))
    result = total / total.sum(axis=1, keepdims=True)
    lips = VISEMES.index("m")
    rise = np.maximum(closed - result[:, lips], 0) / np.maximum(1 - result[:, lips], 1e-9)
    result *= 1 - rise[:, None]
    result[:, lips] += rise
    return result


def talking(phones, starts, times):
    """Return how much the mouth obeys speech, 0..1: during the sentences, which start at times."""
    result = np.zeros(len(times))
    firsts = sorted(starts.values())
    for first, following in zip(firsts, [*firsts[1:], np.inf], strict=True):
        last = max(p.end for p in phones if first <= p.start < following)
        rise = fields.smoothstep(first - 0.2, first - 0.03, times)
        result = np.maximum(result, rise * (1 - fields.smoothstep(last, last + 0.25, times)))
    return result
