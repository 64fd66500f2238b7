"""A take with known truth in source and target: a recorded track of weights moves two rigs.

The folder of the data holds `ict-facekit/` (the actor), `facecap-head/` (the character) and
`livelink/` (the track). Both rigs are in centimetres; everything here is in millimetres.
"""

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np

MARKERS = 102
TRACK = "livelink/alex_rom_3.csv"


class Rig(NamedTuple):
    """Hold a rig that a track moves: positions are ``neutral + sum_c track_c deltas_c``.

    Attributes
    ----------
    neutral : (V, 3) float array [mm]
    deltas : (C, V, 3) float array [mm]
        In the order of the track's channels.
    """

    neutral: np.ndarray
    deltas: np.ndarray


def track(folder):
    """Return the channels' names in ARKit's spelling and the track (T, C)."""
    with (Path(folder) / TRACK).open(encoding="utf-8", newline="") as stream:
        header, *rows = [row for row in csv.reader(stream) if row]
    last = header.index("HeadYaw")
    names = [name[0].lower() + name[1:] for name in header[2:last]]
    return names, np.array([row[2:last] for row in rows], float)


def whole_actor(folder, names):
    """Return the actor's rig at all its vertices."""
    file = _actor_file(folder)
    return _rig(file["neutral"], file["deltas"], list(file["names"]), names)


def actor(folder, names):
    """Return the actor's rig at its markers: the 68 landmarks and points spread over the face."""
    rig = whole_actor(folder, names)
    markers = list(_actor_file(folder)["landmark68"])
    distance = _distance(rig.neutral, markers[0])
    for marker in markers:
        distance = np.minimum(distance, _distance(rig.neutral, marker))
    still = np.linalg.norm(rig.deltas, axis=2).max(axis=0) < 1.0
    distance[still] = 0.0
    while len(markers) < MARKERS:
        markers.append(int(distance.argmax()))
        distance = np.minimum(distance, _distance(rig.neutral, markers[-1]))
    return Rig(rig.neutral[markers], rig.deltas[:, markers])


def character(folder, names):
    """Return the character's rig at the vertices that move."""
    file = np.load(Path(folder) / "facecap-head" / "facecap_head_rig.npz")
    rig = _rig(file["neutral"], file["deltas"], list(file["names"]), names)
    moving = np.linalg.norm(rig.deltas, axis=2).max(axis=0) > 0.01
    return Rig(rig.neutral[moving], rig.deltas[:, moving])


def deltas_of(rig):
    """Return the shapes of a rig as rows, (C, 3V) [mm]."""
    return rig.deltas.reshape(len(rig.deltas), -1)


def opening_of(rig, names):
    """Return how far each channel opens the mouth, (C,) [mm].

    The height of the 20 vertices that raising the upper lip moves most, less that of the 20 that
    lowering the lower lip moves most.
    """
    pairs = ("mouthUpperUp", "mouthLowerDown")
    heights = []
    for pair in pairs:
        both = sum(rig.deltas[names.index(pair + side)] for side in ("Left", "Right"))
        most = np.linalg.norm(both, axis=1).argsort(kind="stable")[-20:]
        heights.append(rig.deltas[:, most, 1].mean(axis=1))
    return heights[0] - heights[1]


def _actor_file(folder):
    """Return the arrays of the actor's rig."""
    return np.load(Path(folder) / "ict-facekit" / "ict_face_rig.npz")


def _rig(neutral, deltas, have, names):
    """Return a rig in millimetres with its shapes in the order of the track's channels."""
    ordered = np.zeros((len(names), *neutral.shape))
    for channel, name in enumerate(names):
        stem = name.removesuffix("Left").removesuffix("Right")
        sided = stem + name[len(stem) :].replace("Left", "_L").replace("Right", "_R")
        # jawLeft and mouthLeft are directions; browInnerUp and cheekPuff are split on one rig
        spellings = {sided, name, f"{name}_L", f"{name}_R"}
        found = [row for row, spelling in enumerate(have) if spelling in spellings]
        ordered[channel] = deltas[found].sum(axis=0)
    return Rig(10.0 * neutral.astype(float), 10.0 * ordered)


def _distance(points, index):
    """Return the distance (V,) of every point from one of them."""
    return np.linalg.norm(points - points[index], axis=1)
