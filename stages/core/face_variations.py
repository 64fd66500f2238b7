"""Labelled faces varied: another light, parts shifted and stretched, starts off their place."""

from collections.abc import Sequence

import numpy as np

from stages.core import face_frame, similarity, warp


def relit(
    image: np.ndarray, gain: float, colour: float, noise: float, rng: np.random.Generator
) -> np.ndarray:
    """Return a picture under another light, with another grain.

    Parameters
    ----------
    image : (H, W, 3) uint8 array
    gain, colour : standard deviations of the log gain of all channels and of each
    noise : standard deviation of the grain [grey levels]
    rng : draws them
    """
    gains = np.exp(gain * rng.normal() + colour * rng.normal(size=3)).astype(np.float32)
    grain = rng.standard_normal(image.shape, np.float32)
    return np.clip(image * gains + np.float32(noise) * grain, 0, 255).astype(np.uint8)


def group_spread(
    upright: np.ndarray, groups: Sequence[np.ndarray], limits: tuple[float, float]
) -> np.ndarray:
    """Measure how much each group of points shifts and stretches among labelled shapes.

    Parameters
    ----------
    upright : (N, P, 2) float array [px], shapes aligned to one another
    groups : R int arrays, the points that move together
    limits : greatest shift [px] and greatest log stretch, since a lid that closes stretches
        without bound

    Returns
    -------
    (R, 2, 2) float array: standard deviations along both axes of shift [px] and of log stretch
    """
    spreads = []
    for group in groups:
        middles, sizes = upright[:, group].mean(axis=1), np.ptp(upright[:, group], axis=1)
        floor = 0.05 * sizes.max() + 1e-9
        spreads.append([middles.std(axis=0), np.log(np.maximum(sizes, floor)).std(axis=0)])
    return np.minimum(spreads, np.array(limits)[:, None])


def stretched(
    shape: np.ndarray,
    groups: Sequence[np.ndarray],
    spread: np.ndarray,
    rng: np.random.Generator,
) -> np.ndarray:
    """Return a shape whose groups are each shifted and stretched along both axes.

    Parameters
    ----------
    shape : (P, 2) float array [px]
    groups : R int arrays, the points that move together
    spread : (R, 2, 2) float array, as from `group_spread`
    rng : draws shifts and stretches
    """
    points = shape.copy()
    for group, (shift, stretch) in zip(groups, spread, strict=True):
        middle = shape[group].mean(axis=0)
        factors = np.exp(stretch * rng.normal(size=2))
        points[group] = middle + factors * (shape[group] - middle) + shift * rng.normal(size=2)
    return points


def bent(
    image: np.ndarray,
    shape: np.ndarray,
    groups: Sequence[np.ndarray],
    spread: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:
    """Return a labelled face (H, W, 3) bent to a stretched shape (P, 2) [px], and that shape."""
    goal = stretched(shape, groups, spread, rng)
    return warp.bend(image, shape, goal), goal


def starts(
    shapes: np.ndarray,
    sources: np.ndarray,
    frame: face_frame.FaceFrame,
    groups: Sequence[np.ndarray],
    spread: tuple[float, float, float],
    group_spread: np.ndarray,
    rng: np.random.Generator,
) -> np.ndarray:
    """Return a start off its place for every source: part of another's shape, moved and stretched.

    Parameters
    ----------
    shapes : (M, P, 2) float array [px]
    sources : (N,) int array, which shape each start belongs to
    frame : the face frame
    groups : int arrays, the points that move together
    spread : standard deviations of shift [px], angle [rad] and log scale
    group_spread : (R, 2, 2) float array, of each group's own shift and stretch
    rng : draws them
    """
    shift, turn, scale = spread
    upright = similarity.aligned(shapes, frame.points)
    found = []
    for source in sources:
        share = rng.random()
        other = upright[rng.integers(len(upright))]
        shape = (1 - share) * upright[source] + share * other
        shape = stretched(shape, groups, group_spread, rng)
        placed = similarity.apply(frame.pose(shapes[source]), shape)
        moved = similarity.about(
            placed.mean(axis=0),
            turn * rng.normal(),
            np.exp(scale * rng.normal()),
            shift * rng.normal(size=2),
        )
        found.append(similarity.apply(moved, placed))
    return np.array(found)
