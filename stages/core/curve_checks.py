"""What looks wrong with the curves of a facial performance, told from the curves alone."""

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

PERCENT_CHECK = "range_0_100"
PERCENT = 2.0  # curves in 0..1 stay below it on half of their moving frames
FAR = 0.5  # beyond the range by so much is more than an exaggerated expression
SOME = 0.05  # curves that never reach it hold nothing to compare
AGREE = 0.5  # correlation below which the sides contradict each other
CLOSED = 0.3  # more of mouthClose than of jawOpen, which it corrects
OFTEN = 0.02  # share of the frames
GAZE = ("eyeLookInLeft", "eyeLookOutLeft", "eyeLookOutRight", "eyeLookInRight")
SIDEWAYS = ("jawLeft", "jawRight", "mouthLeft", "mouthRight")


@dataclasses.dataclass(frozen=True)
class Finding:
    """Something that a person should look at.

    Attributes
    ----------
    check : what kind of thing
    channel : the curve, or several, or nothing for the whole take
    detail : what was found
    cure : what to do
    """

    check: str
    channel: str
    detail: str
    cure: str


def find(
    curves: Mapping[str, np.ndarray],
    wanted: Sequence[str],
    limits: Mapping[str, tuple[float, float]],
    angles: Mapping[str, np.ndarray],
) -> list[Finding]:
    """Check the curves of a take.

    Parameters
    ----------
    curves : canonical name -> (T,) float array
    wanted : canonical names of all channels
    limits : canonical name -> low and high
    angles : `eye_left` and `eye_right` -> (T,) float array, turn of the eye about the y axis,
        positive towards the subject's left [rad]; may be empty

    Returns
    -------
    the findings, the gravest first
    """
    found = _range(curves, limits)
    if found and found[0].check == PERCENT_CHECK:
        curves = {name: values / 100 for name, values in curves.items()}
    found += _sides(curves, angles)
    found += _mouth_close(curves)
    found += [
        Finding("missing", name, "the file has no such channel", "it stays at 0")
        for name in wanted
        if name not in curves
    ]
    found += [
        Finding("all_zero", name, "is 0 on every frame", "it moves nothing; is that intended?")
        for name, values in curves.items()
        if not values.any()
    ]
    return found


def _range(
    curves: Mapping[str, np.ndarray], limits: Mapping[str, tuple[float, float]]
) -> list[Finding]:
    """Report curves in percent, or single ones that are far beyond their range."""
    values = np.concatenate([np.abs(one) for one in curves.values()])
    moving = values[values > SOME]
    if len(moving) and np.median(moving) > PERCENT:
        detail = f"weights reach {values.max():.4g}, as if they ran from 0 to 100"
        cure = "export them from 0 to 1, or give every channel gain 0.01"
        return [Finding(PERCENT_CHECK, "", detail, cure)]
    found = []
    for name, one in curves.items():
        low, high = limits[name]
        reach = one.max() if one.max() - high > low - one.min() else one.min()
        if not low - FAR <= reach <= high + FAR:
            detail = f"reaches {reach:.4g}, its range is {low:g} to {high:g}"
            found.append(Finding("beyond_range", name, detail, "limit it in the channels table"))
    return found


def _sides(curves: Mapping[str, np.ndarray], angles: Mapping[str, np.ndarray]) -> list[Finding]:
    """Report left and right that contradict each other."""
    found = []
    swap = "exchange left and right of one of the pairs"
    if set(GAZE) <= set(curves):
        inner_left, outer_left, outer_right, inner_right = (curves[name] for name in GAZE)
        left, right = inner_left - outer_left, outer_right - inner_right
        if _opposed(left, right):
            detail = "the eyes look to opposite sides"
            found.append(Finding("sides_swapped", " ".join(GAZE), detail, swap))
        elif any(
            _opposed(looked, -angles[eye])
            for eye, looked in (("eye_left", left), ("eye_right", right))
            if eye in angles
        ):
            detail = "the eyes' curves look to the other side than the eyes' angles"
            found.append(Finding("sides_swapped", " ".join(GAZE), detail, "exchange all sides"))
    if set(SIDEWAYS) <= set(curves):
        jaw_left, jaw_right, mouth_left, mouth_right = (curves[name] for name in SIDEWAYS)
        if _opposed(jaw_left - jaw_right, mouth_left - mouth_right):
            detail = "jaw and mouth move to opposite sides"
            found.append(Finding("sides_swapped", " ".join(SIDEWAYS), detail, swap))
    return found


def _opposed(a: np.ndarray, b: np.ndarray) -> bool:
    """Say whether two curves, both of which move, are clearly each other's negative."""
    if min(np.ptp(a), np.ptp(b)) < 4 * SOME:
        return False
    a, b = a - a.mean(), b - b.mean()
    return bool(a @ b < -AGREE * np.sqrt((a @ a) * (b @ b)))


def _mouth_close(curves: Mapping[str, np.ndarray]) -> list[Finding]:
    """Report a mouthClose that closes a mouth whose jaw is not open."""
    if not {"mouthClose", "jawOpen"} <= set(curves):
        return []
    share = float(np.mean(curves["mouthClose"] > curves["jawOpen"] + CLOSED))
    if share <= OFTEN:
        return []
    detail = f"is larger than jawOpen, which it corrects, on {share:.0%} of the frames"
    cure = "it is a pose of its own here; multiply it by jawOpen, or leave it out"
    return [Finding("mouth_close", "mouthClose", detail, cure)]
