import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from stages.core import head_motion, quaternions, rigid_motion

SEEDS = st.integers(0, 2**32 - 1)
METHODS = st.sampled_from(list(head_motion.METHODS))


def moved(neutral, rotations, shifts):
    return neutral @ rotations.as_matrix().transpose(0, 2, 1) + shifts[:, None]


def take(seed, frames=30, count=20):
    rng = np.random.default_rng(seed)
    neutral = rng.normal(size=(count, 3))
    rotations = Rotation.random(frames, random_state=seed)
    shifts = rng.normal(size=(frames, 3))
    return rng, neutral, rotations, shifts, moved(neutral, rotations, shifts)


def test_equation_2_turns_rows_the_way_it_is_read_here():
    # a quarter turn about y brings z to x: by hand, with the paper's own matrices of rows
    neutral = np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 2, 0], [1, 1, 1]])
    frame = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, -1], [0, 2, 0], [1, 1, -1]])
    left, _, right = np.linalg.svd(neutral.T @ frame)
    published = right.T @ left.T
    np.testing.assert_allclose(published, [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=1e-12)
    shift = np.array([5.0, -3, 2])
    points = (frame + shift)[None]
    rotation, translation = head_motion.solve(points, neutral, "published_svd", 0)
    np.testing.assert_allclose(rotation[0], published, atol=1e-12)
    np.testing.assert_allclose(translation[0], shift, atol=1e-12)


@settings(deadline=None, max_examples=40)
@given(SEEDS, METHODS, st.sampled_from([None, 0, 7]))
def test_a_rigid_head_is_recovered_exactly(seed, method, origin):
    _, neutral, rotations, shifts, points = take(seed)
    rotation, translation = head_motion.solve(points, neutral, method, origin)
    np.testing.assert_allclose(rotation, rotations.as_matrix(), atol=1e-9)
    np.testing.assert_allclose(translation, shifts, atol=1e-9)
    face = rigid_motion.remove(points, rotation, translation)
    np.testing.assert_allclose(face, np.broadcast_to(neutral, face.shape), atol=1e-9)


@settings(deadline=None, max_examples=40)
@given(SEEDS, METHODS, st.floats(0, 3))
def test_the_result_is_a_rotation_whatever_the_points_do(seed, method, noise):
    rng, neutral, rotations, shifts, _ = take(seed)
    # almost in a plane and mirrored, where the published formula mirrors
    neutral[:, 2] *= 1e-3
    points = moved(neutral * [1, 1, -1], rotations, shifts)
    points += rng.normal(size=points.shape) * noise
    rotation, _ = head_motion.solve(points, neutral, method)
    rotation = rotation[np.isfinite(rotation).all(axis=(1, 2))]
    np.testing.assert_allclose(np.linalg.det(rotation), 1, atol=1e-9)
    np.testing.assert_allclose(
        rotation @ rotation.transpose(0, 2, 1),
        np.broadcast_to(np.eye(3), rotation.shape),
        atol=1e-9,
    )


@settings(deadline=None, max_examples=40)
@given(SEEDS)
def test_the_weighted_fit_is_scipys(seed):
    rng, neutral, _, _, points = take(seed, frames=4)
    points += rng.normal(size=points.shape)
    weights = rng.random(len(neutral))
    rotation, _ = rigid_motion.fit(points, neutral, weights)
    for frame, found in zip(points, rotation, strict=True):
        here, there = (p - np.average(p, axis=0, weights=weights) for p in (frame, neutral))
        theirs = Rotation.align_vectors(here, there, weights=weights)[0]
        np.testing.assert_allclose(found, theirs.as_matrix(), atol=1e-6)


def test_a_point_of_no_weight_or_place_has_no_part():
    rng, neutral, rotations, shifts, points = take(4)
    points[:, 3] = np.nan
    points[:, 5] += 9
    weights = np.ones(len(neutral))
    weights[5] = 0
    rotation, translation = rigid_motion.fit(points, neutral, weights)
    np.testing.assert_allclose(rotation, rotations.as_matrix(), atol=1e-9)
    np.testing.assert_allclose(translation, shifts, atol=1e-9)


def test_frames_that_tell_no_rotation_stay_unknown():
    _, neutral, _, _, points = take(5)
    points[2, 3:] = np.nan
    points[3, 0] = np.nan
    rotation, translation = rigid_motion.fit(points, neutral, np.ones(len(neutral)), origin=0)
    unknown = np.isnan(rotation).any(axis=(1, 2))
    np.testing.assert_array_equal(np.flatnonzero(unknown), [2, 3])
    np.testing.assert_array_equal(np.isnan(translation).any(axis=1), unknown)
    line = np.linspace(0, 1, 9)[:, None] * [1.0, 2, 3]
    assert np.isnan(rigid_motion.fit(line[None] + 1, line, np.ones(9))[0]).all()


@settings(deadline=None, max_examples=40)
@given(SEEDS, st.lists(st.integers(0, 29), max_size=25))
def test_gaps_are_turned_through_evenly_and_signs_never_jump(seed, lost):
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    # right round and further: the quaternion's double cover shows
    angle = np.linspace(0, 3 * np.pi, 30)
    rotation = Rotation.from_rotvec(angle[:, None] * axis).as_matrix()
    translation = angle[:, None] * rng.normal(size=3)
    rotation[lost], translation[lost] = np.nan, np.nan
    turns, shifts = head_motion.filled(rotation, translation)
    assert np.isfinite(turns).all() and np.isfinite(shifts).all()
    np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1, atol=1e-9)
    assert (np.sum(turns[1:] * turns[:-1], axis=1) > -1e-9).all()
    known = np.setdiff1d(np.arange(30), lost)
    found = Rotation.from_quat(turns[known]).as_matrix()
    np.testing.assert_allclose(found, rotation[known], atol=1e-9)


def test_a_short_gap_lies_on_the_great_circle():
    angle = np.linspace(0, 1.2, 13)
    rotation = Rotation.from_rotvec(angle[:, None] * [0, 1, 0]).as_matrix()
    translation = angle[:, None] * [1.0, 2, 3]
    gone = slice(4, 9)
    rotation[gone], translation[gone] = np.nan, np.nan
    turns, shifts = head_motion.filled(rotation, translation)
    np.testing.assert_allclose(2 * np.arcsin(turns[:, 1]), angle, atol=1e-9)
    np.testing.assert_allclose(shifts, angle[:, None] * [1.0, 2, 3], atol=1e-9)


@settings(deadline=None, max_examples=40)
@given(SEEDS)
def test_quaternions_are_scipys(seed):
    rotations = Rotation.random(50, random_state=seed)
    halves = Rotation.from_rotvec(np.pi * np.eye(3)[[0, 1, 2]])
    both = Rotation.concatenate([rotations, halves, Rotation.identity(1)])
    found = quaternions.from_matrices(both.as_matrix())
    np.testing.assert_allclose(np.abs(np.sum(found * both.as_quat(), axis=1)), 1, atol=1e-12)


def test_faults_are_named():
    with pytest.raises(ValueError, match=r"\(T, P, 3\)"):
        rigid_motion.fit(np.zeros((2, 5, 3)), np.zeros((4, 3)), np.ones(5))
    with pytest.raises(ValueError, match="weights are"):
        rigid_motion.fit(np.zeros((2, 5, 3)), np.zeros((5, 3)), np.ones(4))
    with pytest.raises(ValueError, match="'magic' is none of published_svd"):
        head_motion.solve(np.zeros((2, 5, 3)), np.zeros((5, 3)), "magic")
    for method in head_motion.METHODS:
        with pytest.raises(ValueError, match="markers"):
            head_motion.solve(np.full((2, 5, 3), np.nan), np.eye(5, 3), method)
