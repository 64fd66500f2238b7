"""What looks wrong with a rig of facial shapes, told from its shapes and their names.

Lengths are judged in face units, a rig's distance between the eyes. The subject's left is +x.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from stages.core import local_shapes, rig_mouth

STILL = 1e-6  # face units
SAME = 1e-3  # share of the shape
BIG, SMALL = 15.0, 1 / 12  # times the median of the shapes; on clean rigs 0.29 to 4.9
MEDIAN = (0.01, 2.0)  # face units; on clean rigs 0.13
HEIGHT = (1.2, 60.0)  # face units, from a mask to a whole figure
METRES = (0.005, 1.5)  # of a face unit
COMMON = 0.02  # face units; on clean rigs 0.002
WOBBLE = 0.05  # times the median of the shapes; on clean rigs 0.013
SHARE, FEWEST = 0.6, 5
FAR = 0.1  # face units between the places of a shape and its mirror
HALF = 0.5
SIDEWAYS = ("jawLeft", "jawRight", "mouthLeft", "mouthRight")  # they say where to, not where
UPWARD = {"jawOpen": -1, "browInnerUp": 1, "browOuterUpLeft": 1, "browOuterUpRight": 1}
AXIS = {"y": 1, "z": 2}


class Finding(NamedTuple):
    """Hold something that a person should look at.

    Attributes
    ----------
    check : what kind of thing
    shape : the shape, or several, or nothing for the whole rig
    detail : what was found
    cure : what to do
    """

    check: str
    shape: str
    detail: str
    cure: str


def find(
    names: Sequence[str],
    neutral: np.ndarray,
    deltas: local_shapes.LocalShapes,
    spelt: Mapping[str, Sequence[str]],
    mirrors: Mapping[str, str],
    frame: tuple[str, float, float],
) -> list[Finding]:
    """Check a rig.

    Parameters
    ----------
    names : K names of shapes
    neutral : (V, D) float array; D = 1 for controls, of which only some checks make sense
    deltas : K shapes
    spelt : canonical name -> the rig's own names that stand for it, none if it has none
    mirrors : canonical name of each shape of the left -> that of the right
    frame : the axis that points up, a face unit [the rig's unit], and the unit's length [m]

    Returns
    -------
    the findings, the gravest first
    """
    largest = _largest(deltas) / frame[1]
    if neutral.shape[1] != len("xyz"):
        return _still(names, largest) + _same(names, deltas) + _missing(spelt)
    whole = _unit(neutral, frame) or _common(neutral, deltas, largest, frame[1])
    if whole:  # it spoils all comparisons
        return whole + _still(names, largest) + _missing(spelt)
    rows = {name: [names.index(n) for n in own] for name, own in spelt.items() if own}
    found = _axes(deltas, rows, frame[0])
    found += _sizes(names, largest) or (
        _sides(names, neutral, deltas, rows, mirrors, frame[1])
        + _mouth(neutral, deltas, rows, frame[1])
    )
    return found + _still(names, largest) + _same(names, deltas) + _missing(spelt)


def _rows(deltas: local_shapes.LocalShapes, row: int) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (N,) and differences (N, D) of a shape."""
    part = slice(deltas.first[row], deltas.first[row + 1])
    return deltas.vertices[part], deltas.values[part]


def _largest(deltas: local_shapes.LocalShapes) -> np.ndarray:
    """Return how far each shape moves the vertex that it moves most (K,)."""
    lengths = np.linalg.norm(deltas.values, axis=1)
    parts = zip(deltas.first[:-1], deltas.first[1:], strict=True)
    return np.array([lengths[start:stop].max(initial=0.0) for start, stop in parts])


def _still(names: Sequence[str], largest: np.ndarray) -> list[Finding]:
    """Report shapes that move nothing."""
    cure = "export it again at its full weight, or take it out"
    still = np.flatnonzero(largest <= STILL)
    return [Finding("moves_nothing", names[i], "is the neutral itself", cure) for i in still]


def _same(names: Sequence[str], deltas: local_shapes.LocalShapes) -> list[Finding]:
    """Report shapes that are another one again: ``|a - b| < SAME |a|``."""
    squares = [float((_rows(deltas, row)[1] ** 2).sum()) for row in range(len(names))]
    order = [row for row in np.argsort(squares, kind="stable") if squares[row] > 0]
    found = []
    for place, i in enumerate(order):
        for j in order[place + 1 :]:
            if squares[j] > squares[i] * (1 + SAME) ** 2:
                break
            (a, values_a), (b, values_b) = _rows(deltas, i), _rows(deltas, j)
            _, at_a, at_b = np.intersect1d(a, b, assume_unique=True, return_indices=True)
            shared = float((values_a[at_a] * values_b[at_b]).sum())
            if squares[i] + squares[j] - 2 * shared < SAME**2 * squares[i]:
                pair = " ".join(names[row] for row in sorted((i, j)))
                cure = "sculpt the one that is not yet itself, or take it out"
                found.append(Finding("same", pair, "are one and the same shape", cure))
    return found


def _common(
    neutral: np.ndarray, deltas: local_shapes.LocalShapes, largest: np.ndarray, face_unit: float
) -> list[Finding]:
    """Report a difference that most shapes share: the neutral is not the pose they start from."""
    moving = largest > STILL
    count = int(moving.sum())
    touched = np.flatnonzero(
        np.bincount(deltas.vertices, minlength=deltas.count) > SHARE * max(count, FEWEST)
    )
    if count < FEWEST or not len(touched):
        return []
    step = max(1, 4_000_000 // deltas.values.shape[1] // len(moving))
    chunks = [touched[start : start + step] for start in range(0, len(touched), step)]
    offset = np.zeros(neutral.shape)
    for chunk in chunks:
        offset[chunk] = np.median(local_shapes.at(deltas, chunk)[moving], axis=0)
    far = np.linalg.norm(offset, axis=1).max() / face_unit
    if far < max(COMMON, WOBBLE * np.median(largest[moving])):
        return []
    gain = (offset * neutral).sum() / (neutral * neutral).sum()
    if np.linalg.norm(offset - gain * neutral) < HALF * SHARE * np.linalg.norm(offset):
        detail = f"the shapes are about {1 + gain:.3g} times as large as the neutral"
        return [Finding("scale", "", detail, "export neutral and shapes in the same unit")]
    detail = f"most shapes share a difference from the neutral of up to {far:.2g} face units"
    cure = "the neutral is not the pose that they start from: export it with all weights at 0"
    return [Finding("neutral", "", detail, cure)]


def _unit(neutral: np.ndarray, frame: tuple[str, float, float]) -> list[Finding]:
    """Report a unit that does not fit a face."""
    _, face_unit, metres = frame
    height = np.ptp(neutral, axis=0).max() / face_unit
    if not HEIGHT[0] < height < HEIGHT[1]:
        detail = f"the neutral is {height:.3g} face units long, a head is about 4"
        return [Finding("unit", "", detail, "correct face_unit in characters.tsv")]
    if not METRES[0] < face_unit * metres < METRES[1]:
        detail = f"a face unit is {face_unit * metres:.3g} m, a person's is about 0.06"
        return [Finding("unit", "", detail, "correct unit in characters.tsv")]
    return []


def _axes(
    deltas: local_shapes.LocalShapes, rows: Mapping[str, Sequence[int]], up_axis: str
) -> list[Finding]:
    """Report an axis that does not point up, by where jaw and brows move."""
    votes = []
    for name, sign in UPWARD.items():
        moved = sum(_direction(deltas, row) for row in rows.get(name, []))
        if np.any(moved):
            along = int(np.argmax(np.abs(moved)))
            votes.append(along == AXIS[up_axis] and moved[along] * sign > 0)
    if not votes or np.mean(votes) >= HALF:
        return []
    detail = f"jaw and brows do not move along {up_axis}, which is said to point up"
    cure = "correct up_axis in characters.tsv, or export with that axis up"
    return [Finding("axes", "", detail, cure)]


def _direction(deltas: local_shapes.LocalShapes, row: int) -> np.ndarray:
    """Return where a shape moves (D,): the mean of differences, each weighted by its length."""
    values = _rows(deltas, row)[1]
    lengths = np.linalg.norm(values, axis=1)
    return lengths @ values / max(lengths.sum(), np.finfo(float).tiny)


def _sizes(names: Sequence[str], largest: np.ndarray) -> list[Finding]:
    """Report shapes of another size than the others, or all of an impossible one."""
    if not (largest > STILL).any():
        return []
    median = float(np.median(largest[largest > STILL]))
    if not MEDIAN[0] < median < MEDIAN[1]:
        detail = f"the shapes move {median:.3g} face units, those of a face about 0.1"
        cure = "export them at weight 1, not 100, in the neutral's unit; or correct face_unit"
        return [Finding("size", "", detail, cure)]
    found = []
    for name, size in zip(names, largest, strict=True):
        if size > BIG * median or STILL < size < SMALL * median:
            detail = f"moves {size:.3g} face units, the shapes' median is {median:.3g}"
            cure = "export it at weight 1, not 100 or 0.01, and in the neutral's unit"
            found.append(Finding("size", name, detail, cure))
    return found


def _sides(
    names: Sequence[str],
    neutral: np.ndarray,
    deltas: local_shapes.LocalShapes,
    rows: Mapping[str, Sequence[int]],
    mirrors: Mapping[str, str],
    face_unit: float,
) -> list[Finding]:
    """Report shapes of the left that lie to the right of their mirrors, or move there."""
    judged, swapped = 0, []
    for left, right in mirrors.items():
        pair = [rows.get(left, []), rows.get(right, [])]
        if any(len(own) != 1 for own in pair) or pair[0] == pair[1]:
            continue
        ends = [_across(neutral, deltas, own[0], left in SIDEWAYS) for own in pair]
        scale = max(map(abs, ends)) if left in SIDEWAYS else face_unit
        judged += 1
        if ends[0] - ends[1] < -FAR * scale:
            swapped.append(" ".join(names[own[0]] for own in pair))
    if len(swapped) > max(1, HALF * judged):
        detail = f"{len(swapped)} of {judged} pairs of shapes are on the other side than named"
        cure = "the subject's left is +x: exchange all names, or turn the character"
        return [Finding("sides_swapped", "", detail, cure)]
    detail = "each is on the other side than its name says, the subject's left is +x"
    return [Finding("sides_swapped", pair, detail, "exchange the two") for pair in swapped]


def _across(
    neutral: np.ndarray, deltas: local_shapes.LocalShapes, row: int, sideways: bool
) -> float:
    """Return x of where a shape moves to, or of where it is."""
    if sideways:
        return float(_direction(deltas, row)[0])
    vertices, values = _rows(deltas, row)
    weights = (values**2).sum(axis=1)
    return float(weights @ neutral[vertices, 0] / max(weights.sum(), np.finfo(float).tiny))


def _mouth(
    neutral: np.ndarray,
    deltas: local_shapes.LocalShapes,
    rows: Mapping[str, Sequence[int]],
    face_unit: float,
) -> list[Finding]:
    """Report a mouthClose that is not what jawOpen lacks to closed lips."""
    if any(len(rows.get(name, [])) != 1 for name in ("jawOpen", "mouthClose")):
        return []
    chosen = [rows["jawOpen"][0], rows["mouthClose"][0]]
    jaw, close = local_shapes.dense(local_shapes.select(deltas, np.array(chosen), np.ones(2)))
    fault = rig_mouth.fault(neutral, jaw, close, face_unit)
    return [Finding("mouth_close", "mouthClose", *fault)] if fault else []


def _missing(spelt: Mapping[str, Sequence[str]]) -> list[Finding]:
    """Report the shapes that a rig of ARKit's set lacks."""
    known = sum(bool(own) for own in spelt.values())
    if not known:
        return []
    if known < HALF * len(spelt):
        detail = f"{known} of {len(spelt)} of ARKit's shapes are known by their names"
        return [Finding("names", "", detail, "rename the shapes if curves shall drive the rig")]
    cure = "what its curve shows is lost; sculpt it if that matters"
    lost = [name for name, own in spelt.items() if not own]
    return [Finding("missing", name, "the rig has no such shape", cure) for name in lost]
