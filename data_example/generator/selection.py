"""Choose the frames that the example's artist has locked as key shapes, from the truth."""

import numpy as np
from scipy import optimize

from data_example.generator import contours, landmarks, params

COUNTS = {"mouth": 12, "eyes": 10, "pupils": 5}
CONTOURS = {"mouth": ("lips_",), "eyes": ("eye_", "brow_"), "pupils": ("pupil_",)}
SHOT = "rom"
NEUTRAL_FRAME = 4
APART = 4
# other regions move these features a little: frames where they do are passed over
STILL = {"mouth": (), "eyes": ("gaze_x", "gaze_y"), "pupils": ("blink_l", "blink_r")}


def still_features(take, neutral_brows):
    """Return the point set of every frame as if the head had not moved, (T, P, 2) [mm]."""
    frames = []
    for row in take.expression:
        dense = landmarks.in_space(params.from_row(row), neutral_brows)
        frames.append(contours.point_set({name: line[:, :2] for name, line in dense.items()}))
    return np.stack(frames)


def frames_of(region, take, features):
    """Choose frames one after the other: always the one least like what is chosen so far.

    The residual of a frame is `min |x - sum w_k d_k|` over non-negative weights, `d_k` the
    chosen frames minus the neutral. The neutral itself is no candidate: its sculpt would not
    differ from the neutral mesh.

    Parameters
    ----------
    region : str
    take : shots.Take
    features : (T, P, 2) float array, from still_features

    Returns
    -------
    frames : sorted list of ints
    """
    names = contours.names()
    rows = [i for i, name in enumerate(names) if name.startswith(CONTOURS[region])]
    table = features[:, rows].reshape(len(features), -1)
    table = table - table[NEUTRAL_FRAME]
    moving = [params.NAMES.index(name) for name in STILL[region]]
    allowed = (np.abs(take.expression[:, moving]) < 0.12).all(axis=1)
    chosen = []
    while len(chosen) < COUNTS[region]:
        left = np.linalg.norm(table, axis=1)
        if chosen:
            basis = table[chosen].T
            left = np.array([optimize.nnls(basis, row)[1] for row in table])
        best = int(np.argmax(np.where(allowed, left, -1)))
        chosen.append(best)
        allowed[max(best - APART, 0) : best + APART + 1] = False
    return sorted(chosen)
