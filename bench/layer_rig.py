"""A layered face made of a real rig, and a recorded track that plays it.

The folder of the data is that of `rig_take`. 283 vertices are markers; 18 about the eyes and 22
about the lips are video points, seen from the front. Extremes are picked from the first rows of the
track, as from an actor's: emotions are frames that spread most, speech those of the jaw and lips
alone, blinks the lids' own channels. The rows after those are the performance; no truth is known.
"""

from pathlib import Path

import numpy as np

from bench import layer_faces, rig_take

PICKED_ROWS = 2400
UPPER_LIP, LOWER_LIP = 62, 66  # of the 68 landmarks, which come first
RIGHT_EYE, LEFT_EYE = range(36, 42), range(42, 48)
SIGMA = 0.02
UPPER_LIP, LOWER_LIP = 62, 66  # of the 68 landmarks, which come first
EYES = range(36, 42), range(42, 48)
SIGMA = 0.02
SPOKEN = ("jaw", "mouthFunnel", "mouthPucker", "mouthClose", "mouthUpperUp", "mouthLowerDown")
SPOKEN += ("mouthRoll", "mouthStretch", "mouthPress", "tongue")


def take(folder: Path) -> tuple[layer_faces.Face, layer_faces.Performance]:
    """Return the actor and the performance."""
    names, track = rig_take.track(folder)
    rig = rig_take.whole_actor(folder, names)
    vertices, flat, owner = _points(rig, names)
    shapes = rig.deltas[:, vertices]
    dimension = np.where(flat, 2, 3)
    coordinates = (np.arange(3) < dimension[:, None]).ravel()
    shapes = shapes.reshape(len(names), -1)[:, coordinates]
    masks = np.eye(3)[np.repeat(owner, dimension)].T
    raw = _extremes(names, track[:PICKED_ROWS], shapes)
    face = layer_faces.balanced(raw, np.repeat(flat.astype(int), dimension), masks)
    rows = np.clip(track[PICKED_ROWS:], 0.0, 1.0)
    noise = 0.3 * np.random.default_rng(0).normal(size=(len(rows), shapes.shape[1]))
    frames = (rows @ shapes + noise) / face.unit
    shut = rows @ shapes / face.unit
    closeness = _closeness(rig_take.actor(folder, names), rows)
    blink = layer_faces.closing(face, shut)
    return face, layer_faces.Performance(frames, None, None, closeness, blink)


def _closeness(rig, rows) -> np.ndarray:
    """Return ``exp(-d^2 / 2 sigma^2)`` of the gap between the inner lips, in face units."""
    gap = np.maximum(rows @ (rig.deltas[:, UPPER_LIP, 1] - rig.deltas[:, LOWER_LIP, 1]), 0.0)
    eyes = [rig.neutral[list(eye)].mean(axis=0) for eye in EYES]
    return np.exp(-0.5 * (gap / np.linalg.norm(eyes[0] - eyes[1]) / SIGMA) ** 2)


def _spread(points: np.ndarray, count: int) -> np.ndarray:
    """Return rows that spread most, the first the farthest from zero."""
    distance = np.linalg.norm(points, axis=1)
    chosen = []
    for _ in range(count):
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.array(chosen)


def _points(rig, names) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return vertices (P,), which of them are video points, and the mask of each."""
    blink = sum(rig.deltas[names.index("eyeBlink" + side)] for side in ("Left", "Right"))
    lids = np.flatnonzero(np.linalg.norm(blink, axis=1) > 2.0)
    lids = lids[_spread(rig.neutral[lids], layer_faces.EYE_POINTS)]
    lips = rig.deltas[names.index("mouthPucker")]
    lips = np.argsort(-np.linalg.norm(lips, axis=1), kind="stable")[:400]
    lips = lips[_spread(rig.neutral[lips], layer_faces.LIP_POINTS)]
    moving = np.flatnonzero(np.linalg.norm(rig.deltas, axis=2).max(axis=0) > 1.0)
    markers = moving[_spread(rig.neutral[moving], layer_faces.MARKERS)]
    below = rig.neutral[lips, 1].max() + 10.0
    owner = np.where(rig.neutral[markers, 1] < below, layer_faces.MOUTH, layer_faces.UPPER)
    owner = np.append(owner, np.repeat(layer_faces.EYES, len(lids)))
    owner = np.append(owner, np.repeat(layer_faces.MOUTH, len(lips)))
    flat = np.arange(len(owner)) >= len(markers)
    return np.concatenate([markers, lids, lips]), flat, owner


def _extremes(names, track, shapes) -> np.ndarray:
    """Return the extremes (D, K) [mm]."""
    track = np.clip(track, 0.0, 1.0)
    spoken = np.array([name.startswith(SPOKEN) for name in names])
    blink = np.array([name.startswith("eyeBlink") for name in names])
    emotions, speech, blinks = layer_faces.COUNTS
    played = np.where(blink, 0.3 * track, track) @ shapes
    said = np.where(spoken, track, 0.0) @ shapes
    raw = np.zeros((shapes.shape[1], emotions + speech + blinks))
    raw[:, 1:emotions] = played[_spread(played, emotions - 1)].T
    raw[:, emotions + 1 : emotions + speech] = said[_spread(said, speech - 1)].T
    pressed = [name.startswith(("mouthPress", "mouthRoll")) for name in names]
    raw[:, layer_faces.CLOSED] = 0.3 * np.array(pressed) @ shapes
    raw[:, -2] = 0.5 * blink @ shapes
    raw[:, -1] = blink @ shapes
    return raw
