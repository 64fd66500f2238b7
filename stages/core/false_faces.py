"""Faces made wrong on purpose, to train the judge of points on."""

from collections.abc import Sequence

import numpy as np

from stages.core import similarity

SHIFT = (0.15, 0.8)
GROUP_SHIFT = (0.07, 0.4)


def astray(
    image: np.ndarray, shape: np.ndarray, groups: Sequence[np.ndarray], rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a face whose points all lie off it."""
    del groups
    moved = similarity.about(
        shape.mean(axis=0),
        0.3 * rng.normal(),
        np.exp(0.2 * rng.normal()),
        _direction(rng) * rng.uniform(*SHIFT) * _radius(shape),
    )
    return image, similarity.apply(moved, shape), np.ones(len(shape), bool)


def slipped(
    image: np.ndarray, shape: np.ndarray, groups: Sequence[np.ndarray], rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a face on which one group of points lies off its place."""
    group = groups[rng.integers(len(groups))]
    wrong = np.zeros(len(shape), bool)
    wrong[group] = True
    points = shape.copy()
    points[group] += _direction(rng) * rng.uniform(*GROUP_SHIFT) * _radius(shape)
    return image, points, wrong


def covered(
    image: np.ndarray, shape: np.ndarray, groups: Sequence[np.ndarray], rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a face with something of its own colour before part of it; what it hides is wrong."""
    height, width = image.shape[:2]
    group = groups[rng.integers(len(groups))]
    reach = rng.uniform(0.4, 1.2) * _radius(shape)
    middle = shape[group].mean(axis=0) + 0.3 * reach * rng.normal(size=2)
    y, x = np.mgrid[:height, :width] + 0.5
    offset = np.stack([x, y], axis=-1) - middle
    hidden = np.abs(offset).max(axis=2) < reach
    other = np.roll(image, rng.integers(20, 60, size=2), axis=(0, 1))
    tone = image[tuple(rng.integers(0, side) for side in (height, width))]
    share = rng.random()
    cover = np.rint(share * other + (1 - share) * tone).astype(np.uint8)
    wrong = np.abs(shape - middle).max(axis=1) < reach
    return np.where(hidden[..., None], cover, image), shape, wrong


KINDS = (astray, slipped, covered)


def _direction(rng: np.random.Generator) -> np.ndarray:
    """Return a unit vector of the plane."""
    angle = rng.uniform(0, 2 * np.pi)
    return np.array([np.cos(angle), np.sin(angle)])


def _radius(shape: np.ndarray) -> float:
    """Return the root mean square distance of points from their centre."""
    return float(np.sqrt(((shape - shape.mean(axis=0)) ** 2).sum(axis=1).mean()))
