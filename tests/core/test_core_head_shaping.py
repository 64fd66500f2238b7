import math

import numpy as np
import pytest
import scipy.spatial.transform
from hypothesis import given
from hypothesis import strategies as st

from stages.core import head_shaping, rotation_vectors

Rotation = scipy.spatial.transform.Rotation


def test_vectors_are_those_of_another_library():
    rng = np.random.default_rng(0)
    turns = Rotation.from_rotvec(rng.uniform(-1.5, 1.5, (50, 3)))
    made = rotation_vectors.from_quaternions(turns.as_quat())
    again = Rotation.from_quat(rotation_vectors.to_quaternions(made))
    assert (again * turns.inv()).magnitude().max() < 1e-12
    one = rotation_vectors.from_quaternions(turns.as_quat()[:1])
    np.testing.assert_allclose(one, turns.as_rotvec()[:1], atol=1e-12)


def test_a_motion_past_half_a_turn_does_not_jump():
    angles = np.linspace(0, 1.8 * np.pi, 100)
    quaternions = Rotation.from_euler("y", angles[:, None]).as_quat()
    made = rotation_vectors.from_quaternions(quaternions * np.where(angles > 3, -1, 1)[:, None])
    np.testing.assert_allclose(made[:, 1], angles, atol=1e-12)
    assert rotation_vectors.from_quaternions(np.full((2, 4), np.nan)).shape == (2, 3)


def test_a_still_head_stays():
    still = np.tile([0.0, 0.0, 0.0, 1.0], (3, 1))
    np.testing.assert_array_equal(rotation_vectors.from_quaternions(still), np.zeros((3, 3)))
    np.testing.assert_array_equal(rotation_vectors.to_quaternions(np.zeros((3, 3))), still)


@pytest.mark.parametrize(("axis", "letter"), list(enumerate("xyz")))
def test_each_axis_has_its_own_gain(axis, letter):
    angles = np.linspace(-0.8, 0.8, 9)
    turns = rotation_vectors.from_quaternions(
        Rotation.from_euler(letter, angles[:, None]).as_quat()
    )
    gain = np.array([0.5, 1.5, -1.0])
    made = head_shaping.shaped(turns, np.eye(3), gain, None)
    expected = Rotation.from_euler(letter, gain[axis] * angles[:, None])
    found = Rotation.from_quat(rotation_vectors.to_quaternions(made))
    assert (found * expected.inv()).magnitude().max() < 1e-12


def test_axes_take_the_actors_turns():
    axes = head_shaping.read_axes("z -y +x")
    turns = np.array([[0.1, 0.2, 0.3]])
    made = head_shaping.shaped(turns, axes, np.ones(3), None)
    np.testing.assert_allclose(made, [[0.3, -0.2, 0.1]])


@pytest.mark.parametrize("text", ["x y", "x x z", "x y w", "x --y z", "xyz", ""])
def test_other_axes_are_refused(text):
    with pytest.raises(ValueError, match="is not x, y and z"):
        head_shaping.read_axes(text)


@given(st.floats(0.0, 50.0), st.floats(0.05, 3.0))
def test_a_limit_holds_and_leaves_small_turns(angle, limit):
    turn = np.array([[0.6 * angle, 0.0, 0.8 * angle]])
    # squares of the smallest angles would underflow
    made = math.hypot(*head_shaping.limited(turn, limit)[0])
    assert made <= limit * (1 + 1e-12)
    assert made <= angle * (1 + 1e-12)
    if angle <= 0.5 * limit:
        assert made == pytest.approx(angle)


def test_a_limit_is_soft():
    """Neither the turn nor its speed jumps, and a larger turn stays larger."""
    angles = np.linspace(0, 2, 20001)
    made = head_shaping.limited(np.stack([angles, 0 * angles, 0 * angles], 1), 0.5)[:, 0]
    speed = np.diff(made) / np.diff(angles)
    assert np.abs(np.diff(speed)).max() < 1e-3
    assert (speed > 0).all()
    with pytest.raises(ValueError, match="limit"):
        head_shaping.limited(np.zeros((1, 3)), 0.0)
