"""An actor that is not linear: a hinged jaw, lids that slide on the eyeball, corrective shapes.

Made from a linear rig (`rig_take.actor`) and the same channels. Every channel but the jaw and the
blinks stays a shape; for pairs of channels a corrective shape counts with the product of the two.
"""

from typing import NamedTuple

import numpy as np

# how much of the second shape a full first one takes away
STRENGTH = 0.8
EYE = ("eyeSquint", "eyeWide", "cheekSquint", "eyeLookDown", "eyeLookUp")
BROW = ("browDown", "browOuterUp")
# the 68 landmarks' lids and ends of the jaw line; the hinge below these, the eyeballs' radius [mm]
LIDS = {"Left": slice(42, 48), "Right": slice(36, 42)}
JAW_ENDS, HINGE_BELOW, EYE_RADIUS = [0, 16], 15.0, 12.5


class Actor(NamedTuple):
    """Hold what moves the markers, in millimetres.

    Attributes
    ----------
    neutral : (P, 3) float array
    shapes : (C, P, 3) float array
        Zero for the jaw and the blinks.
    pairs : (N, 2) int array
        Channels whose product drives a corrective.
    correctives : (N, P, 3) float array
    turns : list of (channel, centre, axes, angles)
        Turned about a centre (3,), marker by marker by an axis (P, 3) and an angle (P,) [rad].
    """

    neutral: np.ndarray
    shapes: np.ndarray
    pairs: np.ndarray
    correctives: np.ndarray
    turns: list


def make(rig, names, strength=STRENGTH):
    """Make the actor of a linear rig.

    Parameters
    ----------
    rig : rig_take.Rig
        The first 68 markers are the landmarks.
    names : list of str
        The channels.
    strength : float
        Of the correctives.
    """
    pairs = np.array([[names.index(name) for name in pair] for pair in _pairs(names)])
    correctives = -strength * rig.deltas[pairs[:, 1]]
    shapes = rig.deltas.copy()
    jaw = names.index("jawOpen")
    hinge = rig.neutral[JAW_ENDS].mean(axis=0) - [0.0, HINGE_BELOW, 0.0]
    turns = [(jaw, hinge, *_hinge(rig, jaw, hinge))]
    shapes[jaw] = 0.0
    for side, lids in LIDS.items():
        blink = names.index("eyeBlink" + side)
        centre = rig.neutral[:68][lids].mean(axis=0) - [0.0, 0.0, EYE_RADIUS]
        turns.append((blink, centre, *_arcs(rig, blink, centre)))
        shapes[blink] = 0.0
    return Actor(rig.neutral, shapes, pairs, correctives, turns)


def move(actor, track):
    """Return the positions (T, P, 3) [mm] of the markers at weights (T, C)."""
    products = track[:, actor.pairs].prod(axis=2)
    moved = actor.neutral + np.tensordot(track, actor.shapes, 1)
    moved = moved + np.tensordot(products, actor.correctives, 1)
    for channel, centre, axes, angles in actor.turns[::-1]:
        moved = _turned(moved - centre, axes, track[:, channel, None] * angles) + centre
    return moved


def nonlinearity(actor, track):
    """Return the share of the motion (RMS) that no linear map of the weights explains."""
    moved = move(actor, track).reshape(len(track), -1)
    moved = moved - moved.mean(axis=0)
    centred = track - track.mean(axis=0)
    rest = moved - centred @ np.linalg.lstsq(centred, moved, rcond=None)[0]
    return float(np.linalg.norm(rest) / np.linalg.norm(moved))


def _pairs(names):
    """Return the pairs of channels of which the first, at full weight, holds back the second.

    Stretched skin yields less: an open jaw holds back the mouth, a closed lid what is round the
    eye, a raised brow what else moves it.
    """
    found = [("jawOpen", name) for name in names if name.startswith("mouth")]
    for side in ("Left", "Right"):
        found += [("eyeBlink" + side, name + side) for name in EYE]
        found += [("browInnerUp", name + side) for name in BROW]
    return found


def _hinge(rig, jaw, hinge):
    """Return axes and angles of the jaw: each marker turns by its share of the chin's angle."""
    size = np.linalg.norm(rig.deltas[jaw], axis=1)
    arm = np.linalg.norm((rig.neutral - hinge)[:, 1:], axis=1)
    angles = 2 * np.arcsin(np.clip(size / (2 * arm), 0.0, 1.0))
    return np.tile([1.0, 0.0, 0.0], (len(size), 1)), angles


def _arcs(rig, channel, centre):
    """Return axes and angles that carry each marker along a circle, as far as its shape goes."""
    arm, delta = rig.neutral - centre, rig.deltas[channel]
    axes = np.cross(arm, delta)
    length = np.linalg.norm(axes, axis=1, keepdims=True)
    radius = np.linalg.norm(arm, axis=1)
    angles = 2 * np.arcsin(np.clip(np.linalg.norm(delta, axis=1) / (2 * radius), 0.0, 1.0))
    return axes / np.maximum(length, 1e-9), angles


def _turned(points, axes, angles):
    """Turn points (T, P, 3) about axes (P, 3) by angles (T, P) [rad], Rodrigues' formula."""
    cosine, sine = np.cos(angles)[..., None], np.sin(angles)[..., None]
    along = np.sum(axes * points, axis=2, keepdims=True) * axes
    return points * cosine + np.cross(axes, points) * sine + along * (1 - cosine)
