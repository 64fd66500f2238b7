"""Direct the three takes: expression and head motion of every frame."""

from typing import NamedTuple

import numpy as np
from scipy import interpolate
from scipy.spatial import transform

from data_example.generator import fields, params, speech

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


# (first frame, frames to reach it, frames held, {parameter: value})
ROM = (
    (14, 9, 5, {"jaw_open": 0.55}),
    (30, 9, 5, {"jaw_open": 1.0, "brow_outer_l": 0.3, "brow_outer_r": 0.3}),
    (48, 8, 5, {"smile_l": 1, "smile_r": 1, "squint": 0.45}),
    (
        64,
        8,
        5,
        {
            "smile_l": 1,
            "smile_r": 1,
            "upper_up": 0.5,
            "lower_down": 0.4,
            "jaw_open": 0.12,
            "squint": 0.6,
        },
    ),
    (82, 8, 5, {"pucker": 1}),
    (97, 8, 5, {"funnel": 1, "jaw_open": 0.15}),
    (112, 8, 5, {"funnel": 0.8, "jaw_open": 0.6, "pucker": 0.3, "wide": 0.6}),
    (128, 8, 5, {"stretch": 1, "lower_down": 0.7}),
    (142, 8, 4, {"stretch": 0.8, "jaw_open": 0.5, "lower_down": 0.3, "upper_up": 0.3}),
    (157, 8, 5, {"frown": 1, "brow_inner_l": 0.7, "brow_inner_r": 0.7}),
    (172, 8, 4, {"press": 1}),
    (185, 7, 4, {"smile_l": 1}),
    (198, 7, 4, {"smile_r": 1}),
    (211, 7, 4, {"upper_up": 1, "brow_frown": 0.6, "squint": 0.5}),
    (224, 7, 4, {"lower_down": 1, "jaw_open": 0.1}),
    (236, 7, 4, {"jaw_side": 1, "jaw_open": 0.2}),
    (249, 8, 4, {"jaw_side": -1, "jaw_open": 0.2}),
    (
        263,
        7,
        4,
        {"brow_inner_l": 1, "brow_inner_r": 1, "brow_outer_l": 1, "brow_outer_r": 1, "wide": 1},
    ),
    (278, 7, 5, {"brow_frown": 1, "squint": 0.4}),
    (292, 6, 4, {"brow_outer_l": 1, "brow_inner_l": 0.7}),
    (304, 6, 4, {"brow_outer_r": 1, "brow_inner_r": 0.7}),
    (316, 6, 4, {"wide": 1, "jaw_open": 0.3}),
    (328, 5, 3, {"blink_l": 1, "smile_l": 0.25}),
    (339, 5, 3, {"blink_r": 1, "smile_r": 0.25}),
    (350, 5, 4, {"blink_l": 1, "blink_r": 1}),
    (
        361,
        7,
        4,
        {
            "smile_l": 0.8,
            "smile_r": 0.8,
            "jaw_open": 0.55,
            "upper_up": 0.3,
            "squint": 0.5,
            "brow_outer_l": 0.4,
            "brow_outer_r": 0.4,
        },
    ),
    (376, 7, 4, {"jaw_open": 0.4, "lower_down": 0.8, "upper_up": 0.6, "brow_frown": 0.8}),
    (391, 7, 5, {"lip_close": 1, "jaw_open": 0.3, "pucker": 0.3}),
)
ROM_GAZE = (
    (0, 0, 0),
    (28, 0, 0),
    (36, 0, 0.9),
    (47, 0, 0),
    (84, 1, 0),
    (96, 1, 0),
    (101, -1, 0),
    (112, -1, 0),
    (118, 0, 0),
    (128, 0, 1),
    (138, 0, 1),
    (144, 0, -1),
    (155, 0, -1),
    (160, 0, 0),
    (172, 0.8, 0.8),
    (181, 0.8, 0.8),
    (186, -0.8, 0.8),
    (196, -0.8, 0.8),
    (200, -0.8, -0.8),
    (210, -0.8, -0.8),
    (214, 0.8, -0.8),
    (222, 0.8, -0.8),
    (228, 0, 0),
    (238, 0.7, 0),
    (248, -0.7, 0),
    (262, 0, 0.3),
    (276, 0, 0),
    (300, -0.5, 0.2),
    (312, 0.5, 0.2),
    (322, 0, 0),
    (378, 0, -0.4),
    (392, 0, 0),
    (419, 0, 0),
)


def _ease(knots, count):
    """Return smooth tracks through (frame, value, ...) knots without overshoot, (count, C)."""
    table = np.array(knots, dtype=float)
    return interpolate.PchipInterpolator(table[:, 0], table[:, 1:], extrapolate=True)(
        np.clip(np.arange(count), table[0, 0], table[-1, 0])
    )


def _play(cues, count):
    """Return an expression table in which cues come and go one after the other, (count, N)."""
    table = np.zeros((count, len(params.NAMES)))
    frame = np.arange(count)
    for first, rise, hold, pose in cues:
        up = fields.smoothstep(first, first + rise, frame)
        down = 1 - fields.smoothstep(first + rise + hold, first + 1.9 * rise + hold, frame)
        for name, value in pose.items():
            table[:, params.NAMES.index(name)] += value * up * down
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
    table = _play(ROM, count)
    gaze = _ease(ROM_GAZE, count)
    _set(table, gaze_x=gaze[:, 0], gaze_y=gaze[:, 1])
    _blinks(table, (78, 168, 226, 274, 404))
    angles, shift = _sway(count, 21, (1.6, 2.0, 1.0), (2.0, 1.5, 4.0))
    return _take(table, angles, shift, [], 0.06)


def talk():
    """Return the talking take: a sentence with emphasis, blinks, glances and nods."""
    count = FRAMES["talk"]
    table = np.zeros((count, len(params.NAMES)))
    phones = speech.schedule(pace=0.93)
    tracks = speech.mouth_tracks(phones, np.arange(count) / RATE)
    _set(table, **tracks)
    mood = _ease(
        (
            (0, 0.05, 0),
            (40, 0.2, 0.1),
            (120, 0.1, 0),
            (170, 0.45, 0.15),
            (222, 0.7, 0.35),
            (250, 0.3, 0.1),
            (300, 0.1, 0),
            (352, 0.5, 0.2),
            (385, 0.6, 0.25),
        ),
        count,
    )
    quiet = 1 - 0.55 * table[:, params.NAMES.index("pucker")]
    _set(table, smile_l=mood[:, 0] * quiet, smile_r=0.9 * mood[:, 0] * quiet, squint=mood[:, 1])
    brow = _ease(
        (
            (0, 0, 0),
            (16, 0.9, 0.8),
            (30, 0.2, 0.1),
            (80, 0.1, 0.1),
            (92, 0.5, 0.7),
            (112, 0, 0),
            (150, 0.6, 0.2),
            (178, 0, 0),
            (212, 0.7, 0.8),
            (240, 0.1, 0),
            (262, 0.9, 0.3),
            (290, 0.1, 0.1),
            (318, 0.5, 0.5),
            (350, 0, 0),
            (385, 0.2, 0.1),
        ),
        count,
    )
    _set(
        table,
        brow_inner_l=brow[:, 0],
        brow_inner_r=brow[:, 0],
        brow_outer_l=brow[:, 1],
        brow_outer_r=0.85 * brow[:, 1],
    )
    frown = _ease(
        ((0, 0), (105, 0), (125, 0.55), (145, 0), (292, 0), (306, 0.4), (322, 0), (385, 0)), count
    )
    wide = _ease(((0, 0), (12, 0), (17, 0.7), (30, 0), (385, 0)), count)
    _set(table, brow_frown=frown[:, 0], wide=wide[:, 0])
    glance = _ease(
        (
            (0, 0, 0),
            (40, 0, 0),
            (43, 0.5, -0.1),
            (66, 0.5, -0.1),
            (69, 0, 0),
            (112, 0, 0),
            (115, -0.6, 0.35),
            (142, -0.6, 0.35),
            (145, 0, 0),
            (196, 0, 0),
            (199, 0.3, -0.5),
            (214, 0.3, -0.5),
            (217, 0, 0),
            (268, 0, 0),
            (271, -0.4, 0),
            (288, -0.4, 0),
            (291, 0, 0),
            (385, 0, 0),
        ),
        count,
    )
    _set(table, gaze_x=glance[:, 0], gaze_y=glance[:, 1])
    _blinks(table, (41, 96, 143, 197, 246, 289, 340, 372))
    angles, shift = _sway(count, 22, (3.2, 5.0, 3.0), (5.0, 3.0, 10.0))
    nods = _ease(
        (
            (0, 0, 0),
            (10, 0, 0),
            (18, -4, 0),
            (34, 2, 0),
            (88, 0, 0),
            (98, 4, 0),
            (118, 0, 6),
            (142, 0, 7),
            (160, 0, 0),
            (208, -4, -5),
            (232, 0, -4),
            (262, 4, 3),
            (300, 0, 0),
            (330, 3, 0),
            (350, -2, -3),
            (385, 0, 0),
        ),
        count,
    )
    angles = angles + np.stack([nods[:, 0], 0.6 * nods[:, 1], nods[:, 1]], axis=1)
    return _take(table, angles, shift, phones, 0.08)


def turn():
    """Return the take with strong head motion: nods, shakes, rolls, nearer and farther."""
    count = FRAMES["turn"]
    table = np.zeros((count, len(params.NAMES)))
    text = "_ .4 aa .3 m .15 oh .3 w .15 ee .3 _ .3 m .15 ae .3 s .2 oo .3 m .15 uh .2 _ .5 "
    text += "f .15 aa .3 ee .3 m .2 ih .2 k .1 oh .3 _ .4 w .2 ae .3 l .15 oo .3 m .2 aa .35 _ .7"
    phones = speech.schedule(text)
    _set(table, **speech.mouth_tracks(phones, np.arange(count) / RATE))
    smile = _ease(((0, 0), (40, 0.3), (90, 0.8), (130, 0.2), (180, 0.9), (239, 0.5)), count)[:, 0]
    raised = _ease(
        ((0, 0), (30, 0.6), (70, 0), (120, 0.8), (150, 0.2), (200, 0.7), (239, 0)), count
    )[:, 0]
    _set(table, smile_l=smile, smile_r=smile, squint=0.3 * smile)
    _set(table, brow_inner_l=raised, brow_inner_r=raised, brow_outer_l=raised, brow_outer_r=raised)
    motion = _ease(
        (
            (0, 0, 0, 0, 0),
            (8, 0, 0, 0, 0),
            (20, 13, 0, 0, 0),
            (32, -13, 0, 0, 0),
            (44, 10, 0, 0, 20),
            (56, 0, 12, 0, 30),
            (70, 0, 27, 0, 20),
            (86, 0, -27, 2, 0),
            (100, 0, 22, 0, 0),
            (112, 0, 0, 0, 20),
            (126, 0, 0, 17, 30),
            (144, 0, 0, -18, 30),
            (160, 0, 0, 0, 90),
            (176, 4, -8, 5, 130),
            (194, -3, 8, -6, -40),
            (208, 0, 5, 0, -140),
            (222, 5, 14, 10, -80),
            (239, 0, 0, 0, 0),
        ),
        count,
    )
    _set(table, gaze_x=-0.5 * motion[:, 1] / 27, gaze_y=0.4 * motion[:, 0] / 13)
    _blinks(table, (22, 62, 88, 140, 176, 214))
    _, shift = _sway(count, 23, (1, 1, 1), (14.0, 8.0, 4.0))
    shift = shift + np.stack([np.zeros(count), np.zeros(count), motion[:, 3]], axis=1)
    return _take(table, motion[:, :3], shift, phones, 0.10)


TAKES = {"rom": rom, "talk": talk, "turn": turn}
