"""Direct the marker takes: expression and head motion of Mia at any time, gaps and faults."""

from typing import NamedTuple

import numpy as np
from scipy import interpolate
from scipy.spatial import transform

from data_example.generator import fields, marker_cues, params, speech, spoken

RATE = 120
# the mocap system starts first; its time plus this is the film's time [s]
OFFSET_S = -0.703
FILM_S, LINE_FRAMES = 11.0, 330


class Take(NamedTuple):
    """What happens in a marker take.

    frames : int, number of marker frames
    offset_s : float, the time of the first one on the clock of the notes
    duration_s : float, of the film; 0 without a film
    cues, moods, gaze, head, gaps, faults : str, the director's notes
    blinks : tuple of float [s]
    phones : list of spoken.Phone on the clock of the notes
    """

    frames: int
    offset_s: float
    duration_s: float
    cues: str
    moods: str
    gaze: str
    head: str
    gaps: str
    faults: str
    blinks: tuple
    phones: list


def capture():
    """Return the take that teaches: range of motion, and speech with four expressions."""
    said = spoken.phones()
    phones = []
    for name, start in marker_cues.SENTENCES.items():
        phones += spoken.moved(said[name], start)
    frames = int((FILM_S - OFFSET_S + 0.06) * RATE)
    notes = marker_cues
    return Take(
        frames,
        OFFSET_S,
        FILM_S,
        notes.CAPTURE_ROM,
        notes.CAPTURE_MOODS,
        notes.CAPTURE_GAZE,
        notes.CAPTURE_HEAD,
        notes.CAPTURE_GAPS,
        notes.CAPTURE_FAULTS,
        notes.CAPTURE_BLINKS,
        phones,
    )


def line():
    """Return a later take, markers alone, with a sentence that the other take does not have."""
    phones = spoken.moved(spoken.phones()["line"], marker_cues.LINE_SENTENCE)
    notes = marker_cues
    return Take(
        LINE_FRAMES,
        0.0,
        0.0,
        notes.LINE_ROM,
        notes.LINE_MOODS,
        notes.LINE_GAZE,
        notes.LINE_HEAD,
        notes.LINE_GAPS,
        "",
        notes.LINE_BLINKS,
        phones,
    )


TAKES = {"capture": capture, "line": line}


def marker_times(take):
    """Return the times of the marker frames on the clock of the notes, (T,) [s]."""
    return np.arange(take.frames) / RATE + take.offset_s


def ease(knots, times):
    """Return smooth tracks through `time:value,value` knots without overshoot, (T, C)."""
    table = np.array([k.replace(":", ",").split(",") for k in knots.split()], float)
    at = np.clip(times, table[0, 0], table[-1, 0])
    return interpolate.PchipInterpolator(table[:, 0], table[:, 1:])(at)


def _pose(text):
    """Return a written pose as a row, (N,)."""
    row = np.zeros(len(params.NAMES))
    for name, value in (entry.split("=") for entry in text.split()):
        row[params.NAMES.index(name)] = float(value)
    return row


def blink(times, start):
    """Return a blink that closes in 80 ms, rests for 40 and opens in 160, (T,)."""
    shut = fields.smoothstep(start, start + 0.08, times)
    return shut * (1 - fields.smoothstep(start + 0.12, start + 0.28, times))


def expression(take, times):
    """Return the expression at times on the clock of the notes, (T, N), columns params.NAMES."""
    table = np.zeros((len(times), len(params.NAMES)))
    for notes in take.cues.strip().splitlines():
        first, rise, hold, *pose = notes.split()
        first, rise, hold = float(first), float(rise), float(hold)
        up = fields.smoothstep(first, first + rise, times)
        down = 1 - fields.smoothstep(first + rise + hold, first + 2.2 * rise + hold, times)
        table += np.outer(up * down, _pose(" ".join(pose)))
    tracks = speech.mouth_tracks(spoken.mouths(take.phones), times)
    talking = _talking(take.phones, times)
    for name, track in tracks.items():
        table[:, params.NAMES.index(name)] += talking * track
    # rounded and closed lips leave less room for a smile
    room = 1 - 0.5 * table[:, params.NAMES.index("pucker")]
    for strength, pose in zip(ease(take.moods, times).T, marker_cues.MOODS.values(), strict=True):
        table += np.outer(strength * room, _pose(pose))
    table[:, params.NAMES.index("gaze_y")] += ease(take.gaze, times)[:, 0]
    for start in take.blinks:
        for name in ("blink_l", "blink_r"):
            column = params.NAMES.index(name)
            table[:, column] = np.maximum(table[:, column], blink(times, start))
    return params.limited(table)


def _talking(phones, times):
    """Return how much the mouth obeys speech, 0..1: between the range of motion and the end."""
    first, last = phones[0].start, phones[-1].end
    return fields.smoothstep(first - 0.22, first - 0.04, times) * (
        1 - fields.smoothstep(last + 0.04, last + 0.3, times)
    )


def head(take, times):
    """Return head motion at times: quaternions (T, 4) x, y, z, w and translations (T, 3) [mm]."""
    motion = ease(take.head, times)
    alive = fields.smoothstep(0.3, 0.9, times)[:, None]
    waves = [
        [np.sin(2 * np.pi * f * times + k + 1.7 * axis) for f, k in ((0.53, 0.3), (1.31, 2.1))]
        for axis in range(6)
    ]
    size = np.array([0.9, 1.2, 0.8, 1.5, 1.0, 2.0])
    motion = motion + alive * size * np.array(waves).sum(axis=1).T / 2
    rotation = transform.Rotation.from_euler("YXZ", motion[:, [1, 0, 2]], degrees=True)
    return rotation.as_quat(canonical=True), motion[:, 3:]


def gaps(take):
    """Return the gaps as (marker, first frame, frames)."""
    rows = [row.split() for row in take.gaps.strip().splitlines()]
    return [(name, int(first), int(count)) for name, first, count in rows]


def faults(take):
    """Return the planted faults as (kind, markers, first frame, frames, offset (3,) [mm])."""
    rows = [row.split() for row in take.faults.strip().splitlines()]
    return [
        (kind, names.split(","), int(first), int(count), [float(v) for v in by.split(",")])
        if by != "-"
        else (kind, names.split(","), int(first), int(count), [0.0, 0.0, 0.0])
        for kind, names, first, count, by in rows
    ]
