"""Direct the session `play`: Mia's extremes one by one, and a vignette of layers over each other.

Her face is the actress' own: strengths and coefficients of the layers only set the parameters that
her muscles follow, and lips and lids meet, slide and fold as they do in every take.
"""

from typing import NamedTuple

import numpy as np

from data_example.generator import (
    fields,
    marker_takes,
    params,
    play_cues,
    play_speech,
    spoken,
)

RATE = 60
LAYERS = tuple(play_cues.EXTREMES)
_PARTED = [(layer, name) for layer, found in play_cues.EXTREMES.items() for name in found]
NAMES = [f"{layer}_{name}" for layer, name in _PARTED]
# the parameters that each mask owns
_BROWS = tuple(name for name in params.EYES if name.startswith("brow"))
_EYES = tuple(name for name in params.EYES if not name.startswith("brow")) + params.PUPILS
OWNED = {"upper": _BROWS, "mouth": params.MOUTH, "eyes": _EYES}
MASKS = tuple(OWNED)
VIGNETTE_S = 11.0
# what a talking mouth takes away from the emotion in it
TALKED_AWAY = 0.35
# unlike other parameters, contact goes no further than 1
CONTACT = ("lip_close", "blink_l", "blink_r")
BEYOND = 1.35


class Take(NamedTuple):
    """What happens in a take of the session.

    frames : int, number of marker frames, two to a picture
    head, gaps, faults : str, the director's notes
    phones : list of spoken.Phone
    starts : dict, sentence -> time of its first phone [s]
    """

    frames: int
    head: str
    gaps: str
    faults: str
    phones: list
    starts: dict


class Layers(NamedTuple):
    """What is planted: how strongly each layer acts on each part of the face, and what it wants.

    strength : (T, 3, 3) float array, of the layers on the masks
    coefficient : (T, K) float array, of the extremes NAMES, sum 1 in each layer
    """

    strength: np.ndarray
    coefficient: np.ndarray


def faces():
    """Return the take that teaches: every extreme reached, held and left."""
    frames = max(first + count for _, first, count in holds())
    return Take(frames, play_cues.FACES_HEAD, "", "", [], {})


def vignette():
    """Return the take with four emotions, speech and blinks."""
    said, phones = spoken.phones(), []
    for name, start in play_cues.SENTENCES.items():
        phones += spoken.moved(said[name], start)
    return Take(
        round(VIGNETTE_S * RATE),
        play_cues.VIGNETTE_HEAD,
        play_cues.VIGNETTE_GAPS,
        "",
        phones,
        play_cues.SENTENCES,
    )


TAKES = {"faces": faces, "vignette": vignette}


def holds():
    """Return what is held in `faces` as (extreme, first frame, frames)."""
    result, at = [], 0
    for line in play_cues.FACES.strip().splitlines():
        name, reach, count = line.split()
        result.append((name, at + int(reach), int(count)))
        at += int(reach) + int(count)
    return result


def extreme_frames():
    """Return the frame of each extreme in `faces`, the middle of its longest hold."""
    found = {}
    for name, first, count in holds():
        if name not in found or count > found[name][1]:
            found[name] = first, count
    return {name: found[name][0] + found[name][1] // 2 for name in NAMES}


def pose(text):
    """Return a written pose as a row, (N,); a name without its side stands for both."""
    row = np.zeros(len(params.NAMES))
    for name, value in (entry.split("=") for entry in text.split()):
        for full in (name,) if name in params.NAMES else (f"{name}_l", f"{name}_r"):
            row[params.NAMES.index(full)] = float(value)
    return row


def poses():
    """Return the parameters of every extreme, (K, N)."""
    return np.stack(
        [pose(text) for found in play_cues.EXTREMES.values() for text in found.values()]
    )


def _between(knots, values, times):
    """Return values that ease from each knot to the next, (T, C)."""
    place = np.clip(np.searchsorted(knots, times, "right") - 1, 0, len(knots) - 2)
    share = fields.smoothstep(knots[place], knots[place + 1], times)[:, None]
    return values[place] + share * (values[place + 1] - values[place])


def _columns(layer):
    """Return the columns of a layer's extremes."""
    return [number for number, (owner, _) in enumerate(_PARTED) if owner == layer]


def _resting(count):
    """Return layers that all rest, at full strength everywhere but for speech."""
    coefficient = np.zeros((count, len(NAMES)))
    for layer in LAYERS:
        coefficient[:, _columns(layer)[0]] = 1
    return Layers(np.ones((count, len(MASKS), len(LAYERS))), coefficient)


def _face_layers(times):
    """Return the layers of `faces`: one extreme at a time."""
    knots, values = [], []
    for name, first, count in holds():
        row = _resting(1).coefficient[0]
        row[_columns(name.split("_")[0])] = 0
        row[NAMES.index(name)] = 1
        knots += [first / RATE, (first + count) / RATE]
        values += [row, row]
    layers = _resting(len(times))
    return layers._replace(coefficient=_between(np.array(knots), np.array(values), times))


def _emotions(times):
    """Return strength (T,) and coefficients (T, 15) of the emotions of the vignette."""
    names = list(play_cues.EXTREMES["emotion"])
    knots, values = [], []
    for line in play_cues.VIGNETTE_EMOTIONS.strip().splitlines():
        at, strength, *shares = line.split()
        row = np.zeros(len(names))
        for name, share in (entry.split("=") for entry in shares):
            row[names.index(name)] = float(share)
        knots.append(float(at))
        values.append([float(strength), *row])
    table = _between(np.array(knots), np.array(values), times)
    return table[:, 0], table[:, 1:]


def _vignette_layers(take, times):
    """Return the layers of the vignette."""
    layers = _resting(len(times))
    emotion, wanted = _emotions(times)
    layers.coefficient[:, _columns("emotion")] = wanted
    layers.coefficient[:, _columns("speech")] = play_speech.coefficients(take.phones, times)
    shut = np.max([marker_takes.blink(times, at) for at in play_cues.VIGNETTE_BLINKS], axis=0)
    lids = np.stack([1 - 2 * shut, 1 - np.abs(2 * shut - 1), 2 * shut - 1], axis=1)
    layers.coefficient[:, _columns("blink")] = np.maximum(lids, 0)
    talking = play_speech.talking(take.phones, take.starts, times)
    loud = marker_takes.ease(play_cues.VIGNETTE_SPEECH, times)[:, 0]
    layers.strength[:, :, 0] = emotion[:, None]
    layers.strength[:, 1, 0] *= 1 - TALKED_AWAY * talking
    layers.strength[:, 2, 0] *= 1 - shut
    layers.strength[:, :, 1] = (talking * loud)[:, None]
    return layers


def layers(name, times):
    """Return what is planted in a take at times [s]."""
    if name == "faces":
        return _face_layers(times)
    return _vignette_layers(vignette(), times)


def expression(name, times):
    """Return the expression at times, (T, N), columns params.NAMES: what the layers make together.

    A mask's parameters are the sum of what each layer wants there, by its strength. Lips that an
    emotion keeps together part as soon as she talks, and stressed words and glances are her own.
    """
    planted, basis = layers(name, times), poses()
    table = np.zeros((len(times), len(params.NAMES)))
    for mask, owned in enumerate(OWNED.values()):
        at = [params.NAMES.index(parameter) for parameter in owned]
        for number, layer in enumerate(LAYERS):
            found = _columns(layer)
            wanted = planted.coefficient[:, found] @ basis[np.ix_(found, at)]
            table[:, at] += planted.strength[:, mask, number, None] * wanted
    if name == "vignette":
        _play_freely(table, planted, basis, times)
    table += 0.015 * _life(times)
    low = [-BEYOND if parameter in params.SIGNED else 0.0 for parameter in params.NAMES]
    high = [1.0 if parameter in CONTACT else BEYOND for parameter in params.NAMES]
    return np.clip(table, low, high)


def _play_freely(table, planted, basis, times):
    """Add, in place, what no layer holds: lips that part in speech, glances, stressed words."""
    column = params.NAMES.index("lip_close")
    found = _columns("emotion")
    together = planted.coefficient[:, found] @ basis[found, column]
    talking = np.minimum(planted.strength[:, 1, 1], 1)
    spare = planted.strength[:, 1, 0] - planted.strength[:, 0, 0] * (1 - talking)
    table[:, column] -= np.maximum(spare, 0) * together
    accents = marker_takes.ease(play_cues.VIGNETTE_ACCENTS, times)
    for parameter, track in zip(params.PUPILS, accents.T, strict=False):
        table[:, params.NAMES.index(parameter)] += track
    for parameter in _BROWS:
        if parameter != "brow_frown":
            table[:, params.NAMES.index(parameter)] += accents[:, 2]


def _life(times):
    """Return what never holds quite still in brows and mouth, (T, N) in -1..1."""
    alive = fields.smoothstep(0.45, 0.9, times)[:, None]
    phase = np.arange(len(params.NAMES))
    waves = [np.sin(2 * np.pi * f * times[:, None] + 2.4 * phase) for f in (0.37, 0.83, 1.9)]
    still = np.array([p in CONTACT or p in params.PUPILS for p in params.NAMES])
    return np.where(still, 0, alive * sum(waves) / 3)
