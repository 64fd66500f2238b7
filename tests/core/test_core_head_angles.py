import numpy as np
import scipy.spatial.transform
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import head_angles, quaternions

# a head that looks straight up or down has no yaw of its own
LIMITS = np.array([3.1, 1.55, 3.1])


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1))
def test_angles_come_back_and_are_scipys(seed):
    wanted = np.random.default_rng(seed).uniform(-1, 1, (20, 3)) * LIMITS
    turns = scipy.spatial.transform.Rotation.from_euler("YXZ", wanted).as_quat()
    np.testing.assert_allclose(head_angles.from_quaternions(turns), wanted, atol=1e-6)
    np.testing.assert_allclose(
        head_angles.from_quaternions(quaternions.from_angles(wanted)), wanted, atol=1e-6
    )


def test_straight_down_is_a_quarter_turn():
    turn = quaternions.from_angles(np.array([[0.0, np.pi / 2, 0.0]]))
    np.testing.assert_allclose(head_angles.from_quaternions(turn)[0, 1], np.pi / 2, atol=1e-7)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_angles_about_fixed_axes_are_scipys(seed):
    wanted = np.random.default_rng(seed).uniform(-1, 1, (20, 3)) * LIMITS
    turns = scipy.spatial.transform.Rotation.from_euler("xyz", wanted).as_quat()
    np.testing.assert_allclose(head_angles.about_fixed_axes(turns), wanted, atol=1e-6)
