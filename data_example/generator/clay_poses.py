"""Pose the clay head's extremes as an artist would, by its blendshapes, and say its masks.

They mean what the actress's extremes mean. The artist starts from what she does, rounds to
hundredths, gives every shape a touch more or less, and plays some poses in the head's own way.
"""

import numpy as np

from data_example.generator import clay, clay_shapes, fields, play

TOUCH = 0.08
# contact is exact: what keeps lips together or lids shut is left as it is
EXACT = ("jawOpen", "mouthClose", "eyeBlink")
LEAST = 0.04
# layer and name, and what the artist sets by hand; a name without Left or Right sets both
BY_HAND = """
emotion_serenity eyeBlink=0.38 cheekSquint=0.35 mouthSmile=0.5
emotion_joy jawOpen=0.18 cheekSquint=0.9 mouthSmile=0.95 browOuterUp=0.2
emotion_ecstasy jawOpen=0.45 mouthClose=0 cheekSquint=1 mouthUpperUp=0.5
emotion_trust eyeWide=0.3 mouthSmile=0.38
emotion_fear eyeWide=1 mouthStretch=1 browInnerUp=1 jawOpen=0.15 mouthLowerDown=0.45
emotion_surprise jawOpen=0.24 mouthClose=0 mouthFunnel=0.2 eyeWide=0.7 browOuterUp=0.85
emotion_amazement jawOpen=0.75 mouthClose=0 mouthFunnel=0.3 eyeWide=1
emotion_sadness mouthShrugLower=0.6 mouthFrown=0.95 eyeBlink=0.3
emotion_grief mouthShrugLower=0.8 jawOpen=0.12
emotion_disgust noseSneer=1 cheekSquint=0.7
emotion_anger browDown=1 noseSneer=0.4 mouthFrown=0.45 eyeSquint=0.55 eyeWide=0
emotion_rage browDown=1 noseSneer=1 jawOpen=0.35 eyeWide=0.5
emotion_contempt mouthSmileLeft=0.95 noseSneerLeft=0.4 eyeBlink=0.35 mouthLeft=0.45
speech_aa jawOpen=0.95
speech_oo mouthPucker=1 jawOpen=0.12
speech_m mouthPress=0.5
"""


def _sides(name):
    """Return the shapes that a name stands for."""
    return [n for n in clay_shapes.NAMES if n in (name, f"{name}Left", f"{name}Right")]


def all_poses(seed=44):
    """Return the poses of all extremes but the neutral ones, `<layer>_<name>` -> {shape: weight}.

    Parameters
    ----------
    seed : int, of the artist's touch
    """
    by_hand = {name: cells for name, *cells in map(str.split, BY_HAND.strip().splitlines())}
    result = {}
    for number, (extreme, row) in enumerate(
        zip(play.NAMES, clay_shapes.weights(play.poses()), strict=True)
    ):
        rng = np.random.default_rng([seed, number])
        kinds = dict.fromkeys(_kind(name) for name in clay_shapes.NAMES)
        touch = {kind: 1 + TOUCH * rng.standard_normal() for kind in kinds}
        pose = {
            name: weight * (1 if _kind(name) in EXACT else touch[_kind(name)])
            for name, weight in zip(clay_shapes.NAMES, row, strict=True)
        }
        for cell in by_hand.get(extreme, []):
            name, value = cell.split("=")
            pose |= dict.fromkeys(_sides(name), float(value))
        pose = {name: round(min(float(w), 1), 2) for name, w in pose.items() if w >= LEAST}
        if pose:
            result[extreme] = pose
    return result


def _kind(name):
    """Return a shape's name without its side."""
    return name.removesuffix("Left").removesuffix("Right")


def masks(rig):
    """Return the masks of the head's vertices, (3, V): `upper`, `mouth` and `eyes`, together one.

    Parameters
    ----------
    rig : clay_rig.Clay
    """
    v = rig.neutral * 10
    mouth = fields.smoothstep(-6, -42, v[:, 1])
    eyes = np.zeros(len(v))
    for side in ("r", "l"):
        away = np.linalg.norm((v[: rig.skin] - clay.EYE[side]) / [34, 32, 40], axis=1)
        eyes[: rig.skin] = np.maximum(eyes[: rig.skin], fields.smoothstep(1.15, 0.85, away))
        eyes[rig.slices[f"ball_{side}"]] = 1.0
    rings = clay.RINGS * (clay.INNER + 3)
    mouth[:rings], eyes[:rings] = 1.0, 0.0
    for piece in ("upper", "lower", "tongue"):
        mouth[rig.slices[piece]] = 1.0
    eyes = np.round(eyes, 3)
    mouth = np.round(mouth * (1 - eyes), 3)
    return np.stack([np.round(1 - mouth - eyes, 3), mouth, eyes])
