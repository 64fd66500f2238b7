"""Layered performances with known truth: a drawn face, and a rig that a recorded track moves.

The drawn face has 283 markers in space and 40 video points (18 of the eyes, 22 of the lips), 929
coordinates as in Kholgade 2011, and 29 + 12 + 3 extremes of which the first of each layer is the
one neutral: emotions are sparse sums of smooth local modes of the whole face, speech of those of
the mouth, blinks of the lids.
"""

from typing import NamedTuple

import numpy as np

from stages.core import coordinate_balance

COUNTS = (29, 12, 3)
UPPER, MOUTH, EYES = range(3)
EMOTION, SPEECH, BLINK = range(3)
CLOSED = COUNTS[0] + 1
MARKERS, EYE_POINTS, LIP_POINTS = 283, 18, 22
RATE = 30


class Face(NamedTuple):
    """Hold an actor's extremes.

    Attributes
    ----------
    basis : (D, K) float array [balanced: the mean square of an extreme is one]
    layer : (K,) int array
    masks : (R, D) float array
    unit : (D,) float array, millimetres of one balanced unit
    """

    basis: np.ndarray
    layer: np.ndarray
    masks: np.ndarray
    unit: np.ndarray


class Performance(NamedTuple):
    """Hold frames and the truth that they were made of.

    Attributes
    ----------
    frames : (T, D) float array, with noise and with what no layer explains
    weights : (T, R, J) float array, or None
    coefficients : (T, K) float array, or None
    closeness : (T,) float array, of the lips
    blink : (T,) float array, how far the eyes are shut, 0..1
    """

    frames: np.ndarray
    weights: np.ndarray | None
    coefficients: np.ndarray | None
    closeness: np.ndarray
    blink: np.ndarray


def layers() -> np.ndarray:
    """Return the layer of each extreme."""
    return np.repeat(np.arange(len(COUNTS)), COUNTS)


def balanced(raw: np.ndarray, kinds: np.ndarray, masks: np.ndarray) -> Face:
    """Balance kinds of coordinates as the pipeline does by default.

    Parameters
    ----------
    raw : (D, K) float array [mm]
    kinds : (D,) int array, 0 markers, 1 video points
    masks : (R, D) float array
    """
    unit = 1.0 / coordinate_balance.factors(raw, kinds, masks, "mask_variance")
    return Face(raw / unit[:, None], layers(), masks, unit)


def _places(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return markers (P, 3), points (Q, 2) [mm], and the mask of each marker, then point."""
    flat = rng.uniform([-70, -90], [70, 90], (MARKERS, 2))
    depth = 60.0 - 0.006 * np.sum(flat**2, axis=1)
    angle = np.linspace(0, 2 * np.pi, EYE_POINTS // 2, endpoint=False)
    lid = np.stack([14 * np.cos(angle), 6 * np.sin(angle)], axis=1)
    angle = np.linspace(0, 2 * np.pi, LIP_POINTS, endpoint=False)
    lips = np.stack([25 * np.cos(angle), 9 * np.sin(angle) - 45], axis=1)
    eyes = (lid[None] + np.array([[[-32, 30]], [[32, 30]]])).reshape(-1, 2)
    points = np.concatenate([eyes, lips])
    mask = np.concatenate([np.where(flat[:, 1] < -5, MOUTH, UPPER), np.repeat(EYES, EYE_POINTS)])
    return np.column_stack([flat, depth]), points, np.append(mask, np.repeat(MOUTH, LIP_POINTS))


def _modes(rng, places, centres, width) -> np.ndarray:
    """Return smooth local displacements of all coordinates, one a column (D, N) [mm]."""
    markers, points = places
    columns = []
    for centre in centres:
        push = rng.normal(size=3) * [1.0, 1.4, 0.7]
        near = np.exp(-0.5 * np.sum((markers[:, :2] - centre) ** 2, axis=1) / width**2)
        also = np.exp(-0.5 * np.sum((points - centre) ** 2, axis=1) / width**2)
        columns.append(
            np.append((near[:, None] * push).ravel(), (also[:, None] * push[:2]).ravel())
        )
    return np.array(columns).T


def _lids(points: np.ndarray) -> np.ndarray:
    """Return the displacement of the video points that shuts both eyes, (Q, 2) [mm]."""
    shut = np.zeros_like(points)
    upper = np.arange(len(points)) < EYE_POINTS
    upper &= points[:, 1] > 30.0
    shut[upper, 1] = -1.8 * (points[upper, 1] - 30.0)
    return shut


def drawn_face(seed: int, shared_neutral: bool = True) -> tuple[Face, np.ndarray]:
    """Return a face and motions (D, N) that its extremes do not hold, balanced alike."""
    rng = np.random.default_rng(seed)
    markers, points, owner = _places(rng)
    dimension = np.append(np.repeat(3, MARKERS), np.repeat(2, EYE_POINTS + LIP_POINTS))
    kinds = np.repeat(dimension == 2, dimension).astype(int)
    masks = np.eye(3)[np.repeat(owner, dimension)].T
    places = (markers, points)
    whole = _modes(rng, places, rng.uniform([-55, -75], [55, 75], (45, 2)), 22.0)
    mouth = _modes(rng, places, rng.uniform([-30, -70], [30, -25], (20, 2)), 14.0)
    shut = np.append(np.zeros(3 * MARKERS), _lids(points).ravel())
    lids = shut + 0.3 * _modes(rng, places, [[-32, 36], [32, 36]], 9.0).sum(axis=1)
    raw = np.zeros((len(kinds), sum(COUNTS)))
    for k in range(COUNTS[0]):
        chosen = rng.choice(45, 6, replace=False)
        raw[:, k] = whole[:, chosen] @ rng.exponential(2.5, 6) + rng.uniform(-0.2, 0.5) * shut
    for k in range(COUNTS[0], COUNTS[0] + COUNTS[1]):
        chosen = rng.choice(20, 5, replace=False)
        raw[:, k] = mouth[:, chosen] @ rng.exponential(3.0, 5)
    raw[:, -3:] = np.stack([0.0 * shut, 0.45 * shut + 0.2 * lids, lids], axis=1)
    if shared_neutral:
        raw[:, [0, COUNTS[0]]] = 0.0
    else:
        raw += 2.0 * rng.normal(size=raw.shape)
    face = balanced(raw, kinds, masks)
    return face, _modes(rng, places, rng.uniform([-55, -75], [55, 75], (12, 2)), 18.0) / face.unit[
        :, None
    ]


def _smooth(values: np.ndarray, width: float) -> np.ndarray:
    """Blur along time by a normal kernel of a width in frames, ends repeated."""
    reach = int(4 * width) + 1
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    padded = np.pad(values, ((reach, reach), (0, 0)), mode="edge")
    blurred = [np.convolve(column, kernel / kernel.sum(), "valid") for column in padded.T]
    return np.array(blurred).T


def _turns(rng, count: int, frames: int, length: float, mixed: int) -> np.ndarray:
    """Return one-hot rows (T, count) that change every so often, each a sparse mixture."""
    rows = np.zeros((frames, count))
    start = 0
    while start < frames:
        end = start + 2 + int(rng.exponential(length))
        chosen = rng.choice(count, mixed, replace=False)
        rows[start:end, chosen] = rng.dirichlet(np.ones(mixed))
        start = end
    return rows


def truth(frames: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return weights (T, R, J) and coefficients (T, K) of a played vignette at 30 frames/s.

    An emotion lasts 1.5 s and more and mixes two; phones come ten a second in utterances; a blink
    shuts the eyes every three seconds or so for a sixth of one.
    """
    rng = np.random.default_rng(seed)
    emotion = _smooth(_turns(rng, COUNTS[0], frames, 45, 2), 5.0)
    phones = _smooth(_turns(rng, COUNTS[1], frames, 2, 1), 1.2)
    talk = _smooth(
        (np.sin(np.arange(frames) / 25.0 + rng.uniform(0, 6)) > -0.4)[:, None] * 1.0, 3.0
    )
    talk = talk[:, 0]
    blink = np.zeros(frames)
    for peak in np.cumsum(10 + rng.exponential(80, frames)).astype(int):
        for offset, height in zip(range(-3, 4), (0.1, 0.5, 1.0, 1.0, 0.7, 0.35, 0.1), strict=True):
            if 0 <= peak + offset < frames:
                blink[peak + offset] = height
    half = np.minimum(blink, 1 - blink)
    lids = np.stack([np.maximum(1 - 2 * blink, 0), 2 * half, np.maximum(2 * blink - 1, 0)], axis=1)
    weights = np.zeros((frames, 3, 3))
    weights[:, UPPER] = np.stack([1 - 0.15 * talk, 0.15 * talk, 0 * talk], axis=1)
    weights[:, MOUTH] = np.stack([1 - 0.75 * talk, 0.75 * talk, 0 * talk], axis=1)
    weights[:, EYES, EMOTION] = 1 - 0.9 * blink
    weights[:, EYES, BLINK] = 0.9 * blink
    return weights, np.concatenate([emotion, phones, lids], axis=1)


def composed(face: Face, weights: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Return ``sum_l M_l sum_j w_lj B_j a_j``, (T, D) [balanced]."""
    total = np.zeros((len(weights), len(face.basis)))
    for mask, of_layers in zip(face.masks, np.swapaxes(weights, 0, 1), strict=True):
        total += mask * ((of_layers[:, face.layer] * coefficients) @ face.basis.T)
    return total


def closing(face: Face, frames: np.ndarray) -> np.ndarray:
    """Return how far frames (T, D) shut the eyes: their component along the shut eyes'."""
    shut = np.where(face.masks[EYES] > 0.5, face.basis[:, -1] * face.unit, 0.0)
    return (frames * face.unit) @ shut / (shut @ shut)


def performed(
    face: Face,
    extra: np.ndarray,
    frames: int,
    seed: int,
    noise_mm: float = 0.3,
    extra_mm: float = 1.0,
) -> Performance:
    """Return a vignette with noise and with slow motions that no extreme holds (RMS over time)."""
    rng = np.random.default_rng(seed)
    weights, coefficients = truth(frames, seed + 1)
    exact = composed(face, weights, coefficients)
    drift = _smooth(rng.normal(size=(frames, extra.shape[1])), 8.0)
    drift *= extra_mm / max(np.sqrt(np.mean((drift @ extra.T * face.unit) ** 2)), 1e-12)
    noise = noise_mm * rng.normal(size=exact.shape) / face.unit
    apart = 1.0 - weights[:, MOUTH, SPEECH] / 0.75 * coefficients[:, CLOSED]
    closeness = np.exp(-0.5 * (apart / 0.25) ** 2)
    blink = closing(face, exact)
    return Performance(exact + noise + drift @ extra.T, weights, coefficients, closeness, blink)
