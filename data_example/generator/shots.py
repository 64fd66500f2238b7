"""Direct the three takes: expression and head motion of every frame."""

from typing import NamedTuple

import numpy as np
from scipy import interpolate
from scipy.spatial import transform

from data_example.generator import cues, fields, params, speech

RATE = 30
FRAMES = {"rom": 420, "talk": 386, "turn": 240}


class Take(NamedTuple):
    """What happens in a shot.

    expression : (T, N) float array, columns as params.NAMES
    quaternion : (T, 4) float array, head rotation x, y, z, w
    translation : (T, 3) float array [mm]
    light : (T,) float array, factor on the key light
    phones : list of (name, start, end) [s]
    """

    expression: np.ndarray
    quaternion: np.ndarray
    translation: np.ndarray
    light: np.ndarray
    phones: list


def _ease(knots, count):
    """Return smooth tracks through `frame:value,value` knots without overshoot, (count, C)."""
    rows = [knot.replace(":", ",").split(",") for knot in knots.split()]
    table = np.array(rows, dtype=float)
    return interpolate.PchipInterpolator(table[:, 0], table[:, 1:])(
        np.clip(np.arange(count), table[0, 0], table[-1, 0])
    )


def _play(notes, count):
    """Return an expression table in which cues come and go one after the other, (count, N)."""
    table = np.zeros((count, len(params.NAMES)))
    frame = np.arange(count)
    for line in notes.strip().splitlines():
        first, rise, hold, *pose = line.split()
        first, rise, hold = int(first), int(rise), int(hold)
        up = fields.smoothstep(first, first + rise, frame)
        down = 1 - fields.smoothstep(first + rise + hold, first + 1.9 * rise + hold, frame)
        for name, value in (entry.split("=") for entry in pose):
            table[:, params.NAMES.index(name)] += float(value) * up * down
    return table


def _blinks(table, frames, depth=1.0):
    """Add blinks that close within two frames and open within four."""
    shape = depth * np.array([0.45, 1.0, 1.0, 0.72, 0.38, 0.12])
    for start in frames:
        for name in ("blink_l", "blink_r"):
            column = params.NAMES.index(name)
            rows = slice(start, start + len(shape))
            table[rows, column] = np.maximum(table[rows, column], shape[: len(table[rows])])


def _set(table, **tracks):
    """Add tracks to the named columns of an expression table."""
    for name, track in tracks.items():
        table[:, params.NAMES.index(name)] += track


def _sway(count, seed, degrees, mm):
    """Return slow idle motion: Euler angles (T, 3) [degrees] and translation (T, 3) [mm]."""
    rng = np.random.default_rng(seed)
    t = np.arange(count) / RATE
    start = fields.smoothstep(4, 24, np.arange(count))[:, None]

    def wander(size):
        waves = [
            rng.uniform(0.4, 1) * np.sin(2 * np.pi * f * t + rng.uniform(0, 6.3))
            for f in (0.11, 0.23, 0.41, 0.73)
        ]
        return size * sum(waves) / 2

    angles = np.stack([wander(d) for d in degrees], axis=1) * start
    return angles, np.stack([wander(m) for m in mm], axis=1) * start


def _take(table, angles, translation, phones, drift):
    """Return a take from Euler angles pitch, yaw, roll [degrees]."""
    count = len(table)
    rotation = transform.Rotation.from_euler("YXZ", angles[:, [1, 0, 2]], degrees=True)
    t = np.arange(count) / max(count - 1, 1)
    light = 1 + drift * np.sin(2 * np.pi * (0.8 * t + 0.1))
    return Take(params.limited(table), rotation.as_quat(canonical=True), translation, light, phones)


def rom():
    """Return the range-of-motion take: every extreme, gaze all round, little head motion."""
    count = FRAMES["rom"]
    table = _play(cues.ROM, count)
    gaze = _ease(cues.ROM_GAZE, count)
    _set(table, gaze_x=gaze[:, 0], gaze_y=gaze[:, 1])
    _blinks(table, (78, 168, 226, 274, 404))
    angles, shift = _sway(count, 21, (1.6, 2.0, 1.0), (2.0, 1.5, 4.0))
    return _take(table, angles, shift, [], 0.06)


def talk():
    """Return the talking take: a sentence with emphasis, blinks, glances and nods."""
    count = FRAMES["talk"]
    table = np.zeros((count, len(params.NAMES)))
    phones = speech.schedule(cues.TALK_SPEECH, pace=0.93)
    tracks = speech.mouth_tracks(phones, np.arange(count) / RATE)
    _set(table, **tracks)
    mood = _ease(cues.TALK_MOOD, count)
    quiet = 1 - 0.55 * table[:, params.NAMES.index("pucker")]
    _set(table, smile_l=mood[:, 0] * quiet, smile_r=0.9 * mood[:, 0] * quiet, squint=mood[:, 1])
    brow = _ease(cues.TALK_BROWS, count)
    _set(
        table,
        brow_inner_l=brow[:, 0],
        brow_inner_r=brow[:, 0],
        brow_outer_l=brow[:, 1],
        brow_outer_r=0.85 * brow[:, 1],
    )
    frown = _ease(cues.TALK_FROWN, count)
    wide = _ease(cues.TALK_WIDE, count)
    _set(table, brow_frown=frown[:, 0], wide=wide[:, 0])
    glance = _ease(cues.TALK_GAZE, count)
    _set(table, gaze_x=glance[:, 0], gaze_y=glance[:, 1])
    _blinks(table, (41, 96, 143, 197, 246, 289, 340, 372))
    angles, shift = _sway(count, 22, (3.2, 5.0, 3.0), (5.0, 3.0, 10.0))
    nods = _ease(cues.TALK_HEAD, count)
    angles = angles + np.stack([nods[:, 0], 0.6 * nods[:, 1], nods[:, 1]], axis=1)
    return _take(table, angles, shift, phones, 0.08)


def turn():
    """Return the take with strong head motion: nods, shakes, rolls, nearer and farther."""
    count = FRAMES["turn"]
    table = np.zeros((count, len(params.NAMES)))
    phones = speech.schedule(cues.TURN_SPEECH)
    _set(table, **speech.mouth_tracks(phones, np.arange(count) / RATE))
    smile = _ease(cues.TURN_SMILE, count)[:, 0]
    raised = _ease(cues.TURN_BROWS, count)[:, 0]
    _set(table, smile_l=smile, smile_r=smile, squint=0.3 * smile)
    _set(table, brow_inner_l=raised, brow_inner_r=raised, brow_outer_l=raised, brow_outer_r=raised)
    motion = _ease(cues.TURN_HEAD, count)
    _set(table, gaze_x=-0.5 * motion[:, 1] / 27, gaze_y=0.4 * motion[:, 0] / 13)
    _blinks(table, (22, 62, 88, 140, 176, 214))
    _, shift = _sway(count, 23, (1, 1, 1), (14.0, 8.0, 4.0))
    shift = shift + np.stack([np.zeros(count), np.zeros(count), motion[:, 3]], axis=1)
    return _take(table, motion[:, :3], shift, phones, 0.10)


TAKES = {"rom": rom, "talk": talk, "turn": turn}
