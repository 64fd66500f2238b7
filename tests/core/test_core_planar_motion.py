import numpy as np
import pytest

from stages.core import planar_motion

FRAMES, STILL, MOVING = 120, 40, 24
VOTES = np.ones(STILL + MOVING)


def synthetic_take(rng, jaw=0.3, yaw=0.0):
    """Draw a face whose lower part moves, and a head that moves as a whole."""
    neutral = np.concatenate(
        [
            rng.uniform([-1, -0.3], [1, 0.6], (STILL, 2)),
            rng.uniform([-0.5, -1.5], [0.5, -1], (MOVING, 2)),
        ]
    )
    opening = rng.uniform(0, 1, FRAMES)
    face = np.repeat(neutral[None], FRAMES, axis=0)
    face[:, STILL:, 1] -= jaw * opening[:, None]
    face += rng.normal(0, 0.004, face.shape)
    angle, scale = rng.normal(0, 0.15, FRAMES), 1 + rng.normal(0, 0.05, FRAMES)
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    linear = scale[:, None, None] * rotation.transpose(2, 0, 1)
    linear = linear * np.stack([np.cos(rng.normal(0, yaw, FRAMES)), np.ones(FRAMES)], -1)[:, None]
    translation = rng.normal(0, 0.3, (FRAMES, 2))
    points = np.einsum("tij,tpj->tpi", linear, face) + translation[:, None]
    return neutral, face, points, angle, scale


def test_motion_is_recovered_under_a_moving_jaw_as_well_as_by_an_oracle():
    rng = np.random.default_rng(3)
    neutral, face, points, angle, scale = synthetic_take(rng)
    deviation = planar_motion.clip_deviation(points, neutral, VOTES, 0)
    oracle = np.where(np.arange(STILL + MOVING) < STILL, 0.006, 100.0)
    errors = []
    for chosen in (deviation, oracle):
        linear, _ = planar_motion.fit(points, neutral, chosen)
        found, size = planar_motion.decompose(linear)
        errors.append(np.abs(found - angle).mean())
    assert errors[0] <= 1.2 * errors[1]
    assert np.degrees(errors[0]) < 0.1
    assert np.abs(size - scale).mean() < 0.01


def test_expression_is_recovered_when_the_head_turns_and_foreshortens():
    rng = np.random.default_rng(4)
    neutral, face, points, *_ = synthetic_take(rng, yaw=0.3)
    deviation = planar_motion.clip_deviation(points, neutral, VOTES, 0)
    linear, translation = planar_motion.fit(points, neutral, deviation)
    assert np.abs(planar_motion.remove(points, linear, translation) - face).mean() < 0.005
    # the plain mean of squares takes the jaw for head motion
    even = np.full(len(neutral), 0.1)
    plain = planar_motion.remove(points, *planar_motion.fit(points, neutral, even))
    assert np.abs(plain - face).mean() > 0.01


def test_frames_without_enough_points_stay_unknown_and_gaps_do_no_harm():
    rng = np.random.default_rng(5)
    neutral, face, points, angle, _ = synthetic_take(rng)
    points[7] = np.nan
    points[20, :30] = np.nan
    deviation = planar_motion.clip_deviation(points, neutral, VOTES, 0)
    linear, _ = planar_motion.fit(points, neutral, deviation)
    found, _ = planar_motion.decompose(linear)
    assert np.isnan(found[7]) and np.isfinite(np.delete(found, 7)).all()
    assert abs(found[20] - angle[20]) < 0.02


def test_decompose_follows_a_head_that_turns_right_round():
    angle = np.linspace(0, 3 * np.pi, 50)
    linear = 1.5 * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    found, scale = planar_motion.decompose(linear.transpose(2, 0, 1))
    np.testing.assert_allclose(found, angle)
    np.testing.assert_allclose(scale, 1.5)


def test_shapes_that_disagree_and_an_empty_clip_are_refused():
    with pytest.raises(ValueError, match=r"\(T, P, 2\)"):
        planar_motion.fit(np.zeros((5, 4, 2)), np.zeros((3, 2)), np.ones(3))
    with pytest.raises(ValueError, match="none of 5 frames"):
        planar_motion.clip_deviation(np.full((5, 6, 2), np.nan), np.zeros((6, 2)), np.ones(6), 0)
