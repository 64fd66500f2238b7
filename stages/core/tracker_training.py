"""Learning a tracker from a handful of labelled frames (CB02 section 3, and its refinement)."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from stages.core import (
    confidence,
    descent,
    eigen_points,
    face_frame,
    face_search,
    face_tracker,
    face_variations,
    false_faces,
    morph,
    similarity,
    warp,
)

METHODS = ("eigen_points", "eigen_points_descent")
LEAST_LABELLED = 3
RADIUS_PX = 57.0
MARGIN_PX = 20.0
TRAINING_MARGIN_PX = 26
COMPONENTS = 15
FRACTIONS = (0.25, 0.5, 0.75)
MORPH_LIMIT = 240
LABEL_WEIGHT = 3
STARTS = 3
RIDGES = (15.0, 15.0, 8.0, 4.0)
START_SPREAD = (2.0, 0.03, 0.03)
START_GROUP = 0.5
BENT = 8
BENT_GROUP = 1.5
GROUP_LIMITS = (4.0, 0.3)
LIGHT = (0.15, 0.08, 1.5)
JUDGED_MORPHS = 60
JUDGED_REPEATS = 4
JUDGED_ERROR_PX = 0.8


@dataclasses.dataclass(frozen=True)
class Faces:
    """Labelled faces and their morphs, pre-warped with room round them.

    Attributes
    ----------
    images : (M, H, W, 3) uint8 array
    shapes : (M, P, 2) float array [px of those]
    parents : (M, 2) int array, the labelled frames that each comes from
    labelled : how many are labelled frames themselves; they come first
    """

    images: np.ndarray
    shapes: np.ndarray
    parents: np.ndarray
    labelled: int


def train(
    pictures: Sequence[np.ndarray],
    shapes: np.ndarray,
    groups: Sequence[np.ndarray],
    method: str,
    seed: int,
) -> face_tracker.FaceTracker:
    """Learn a tracker.

    Parameters
    ----------
    pictures : N pictures, (H, W, 3) uint8 arrays, RGB
    shapes : (N, P, 2) float array [px], their labelled points
    groups : int arrays that hold each point once
    method : `eigen_points` as published, or `eigen_points_descent`, which refines them and adds
        faces bent to new shapes to the morphs
    seed : of the perturbations

    Raises
    ------
    ValueError
        if there are too few labelled frames, points outside every group, or no such method
    """
    if method not in METHODS:
        raise ValueError(f"method {method} is none of {', '.join(METHODS)}")
    if len(pictures) < LEAST_LABELLED:
        raise ValueError(f"{len(pictures)} labelled frames are too few: at least {LEAST_LABELLED}")
    if sorted(np.concatenate(groups)) != list(range(shapes.shape[1])):
        raise ValueError(f"groups do not hold each of {shapes.shape[1]} points once")
    rng = np.random.default_rng(seed)
    frame = face_frame.around(similarity.mean_shape(shapes, RADIUS_PX), MARGIN_PX)
    faces = _faces(pictures, shapes, frame, rng)
    cascade = descent.Descent((), ())
    images, varied = faces.images, faces.shapes
    if method == "eigen_points_descent":
        upright = similarity.aligned(faces.shapes[: faces.labelled], frame.points)
        spread = face_variations.group_spread(upright, groups, GROUP_LIMITS)
        images, varied = _bent(faces, groups, spread, rng)
        cascade = _cascade(images, varied, faces.labelled, frame, groups, spread, rng)
    eigen = eigen_points.train(images, varied, frame, COMPONENTS)
    judge = _judge(faces, frame, groups, rng)
    scales = np.array([np.sqrt(np.linalg.det(frame.pose(s)[:, :2])) for s in shapes])
    fronts = np.array(
        [warp.prewarp(p, frame.pose(s), frame.size) for p, s in zip(pictures, shapes, strict=True)]
    )
    finder = face_search.train(fronts, scales, frame)
    return face_tracker.FaceTracker(frame, tuple(groups), eigen, cascade, judge, finder)


def _faces(
    pictures: Sequence[np.ndarray],
    shapes: np.ndarray,
    frame: face_frame.FaceFrame,
    rng: np.random.Generator,
) -> Faces:
    """Pre-warp the labelled frames and morph between them."""
    wide = face_frame.widened(frame, TRAINING_MARGIN_PX)
    poses = [wide.pose(shape) for shape in shapes]
    images = np.array(
        [
            warp.prewarp(picture, pose, wide.size)
            for picture, pose in zip(pictures, poses, strict=True)
        ]
    )
    local = np.array(
        [similarity.unapply(pose, shape) for pose, shape in zip(poses, shapes, strict=True)]
    )
    morphs, bent, parents = morph.enlarge(images, local, FRACTIONS, MORPH_LIMIT, rng)
    own = np.arange(len(shapes))
    return Faces(
        np.concatenate([images, morphs]),
        np.concatenate([local, bent]),
        np.concatenate([np.stack([own, own], axis=1), parents]),
        len(shapes),
    )


def _bent(
    faces: Faces, groups: Sequence[np.ndarray], spread: np.ndarray, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Add labelled faces bent to shapes that nobody labelled; return all images and shapes."""
    labelled = list(zip(faces.images, faces.shapes, strict=True))[: faces.labelled]
    bent = [
        face_variations.bent(image, shape, groups, BENT_GROUP * spread, rng)
        for image, shape in labelled
        for _ in range(BENT)
    ]
    images = np.array([*faces.images, *(image for image, _ in bent)])
    return images, np.array([*faces.shapes, *(shape for _, shape in bent)])


def _cascade(
    images: np.ndarray,
    shapes: np.ndarray,
    labelled: int,
    frame: face_frame.FaceFrame,
    groups: Sequence[np.ndarray],
    spread: np.ndarray,
    rng: np.random.Generator,
) -> descent.Descent:
    """Train the refinement from perturbed starts under changed light."""
    repeats = np.full(len(images), STARTS)
    repeats[:labelled] *= LABEL_WEIGHT
    sources = np.repeat(np.arange(len(repeats)), repeats)
    lit = np.array([face_variations.relit(images[m], *LIGHT, rng) for m in sources])
    starts = face_variations.starts(
        shapes, sources, frame, groups, START_SPREAD, START_GROUP * spread, rng
    )
    cascade, _ = descent.train(lit, sources, shapes[sources], starts, frame, groups, RIDGES)
    return cascade


def _judge(
    faces: Faces,
    frame: face_frame.FaceFrame,
    groups: Sequence[np.ndarray],
    rng: np.random.Generator,
) -> confidence.Judge:
    """Train the judge on left-out labelled faces and on false ones."""
    count = faces.labelled
    morphs = np.linspace(count, len(faces.images) - 1, JUDGED_MORPHS).astype(int)
    chosen = np.concatenate([np.arange(count), np.unique(morphs)])
    seen = np.array([described(faces.images[m], faces.shapes[m], frame) for m in chosen])
    mean, basis = confidence.span(seen)
    right, wrong, is_wrong = [], [], []
    for i in range(count):
        own = (faces.images[i], faces.shapes[i])
        left_out = confidence.span(seen[(faces.parents[chosen] != i).all(axis=1)])
        for _ in range(JUDGED_REPEATS):
            image = face_variations.relit(own[0], *LIGHT, rng)
            shape = own[1] + JUDGED_ERROR_PX * rng.normal(size=own[1].shape)
            right.append(confidence.log_distance(*left_out, described(image, shape, frame)))
            for make in false_faces.KINDS:
                image, shape, bad = make(*own, groups, rng)
                wrong.append(confidence.log_distance(mean, basis, described(image, shape, frame)))
                is_wrong.append(bad)
    return confidence.train(
        mean, basis, np.array(right), np.array(wrong), np.array(is_wrong), groups
    )


def described(image: np.ndarray, shape: np.ndarray, frame: face_frame.FaceFrame) -> np.ndarray:
    """Return the descriptors (P, F) of a face at given points."""
    return descent.describe(descent.look(image, frame, shape), shape)
