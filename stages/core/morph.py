"""Morphs between labelled faces, which enlarge the set that a tracker learns from (CB02 section 3).

A morph bends two pictures to one shape between theirs and mixes them.
"""

import itertools

import numpy as np

from stages.core import warp


def between(
    images: tuple[np.ndarray, np.ndarray], shapes: tuple[np.ndarray, np.ndarray], fraction: float
) -> tuple[np.ndarray, np.ndarray]:
    """Morph one labelled picture into another.

    Parameters
    ----------
    images : two (H, W, 3) uint8 arrays
    shapes : their points, two (P, 2) float arrays [px]
    fraction : 0 gives the first, 1 the second

    Returns
    -------
    image : (H, W, 3) uint8 array
    shape : (P, 2) float array [px]
    """
    shape = (1 - fraction) * shapes[0] + fraction * shapes[1]
    bent = [
        warp.bend(image, own, shape).astype(np.float32)
        for image, own in zip(images, shapes, strict=True)
    ]
    mixed = (1 - fraction) * bent[0] + fraction * bent[1]
    return np.rint(mixed).astype(np.uint8), shape


def enlarge(
    images: np.ndarray,
    shapes: np.ndarray,
    fractions: tuple[float, ...],
    limit: int,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Morph every pair of labelled faces, or as many drawn pairs as the limit allows.

    Parameters
    ----------
    images : (N, H, W, 3) uint8 array, pre-warped faces
    shapes : (N, P, 2) float array [px]
    fractions : where between the two to stop
    limit : greatest number of morphs
    rng : draws pairs where there are too many

    Returns
    -------
    images : (M, H, W, 3) uint8 array, the morphs alone
    shapes : (M, P, 2) float array [px]
    parents : (M, 2) int array, which two each came from
    """
    jobs = list(itertools.product(itertools.combinations(range(len(images)), 2), fractions))
    if len(jobs) > limit:
        jobs = [jobs[i] for i in np.sort(rng.choice(len(jobs), limit, replace=False))]
    made = [
        between((images[i], images[j]), (shapes[i], shapes[j]), fraction)
        for (i, j), fraction in jobs
    ]
    morphs = np.array([image for image, _ in made], np.uint8).reshape(-1, *images.shape[1:])
    bent = np.array([shape for _, shape in made]).reshape(-1, *shapes.shape[1:])
    return morphs, bent, np.array([pair for pair, _ in jobs], int).reshape(-1, 2)
