import numpy as np
import pytest
import scipy.spatial.transform
from hypothesis import given
from hypothesis import strategies as st

from stages.core import head_transform


@given(st.integers(0, 2**32 - 1))
def test_rotation_matrix_is_scipys(seed):
    quaternion = np.random.default_rng(seed).normal(size=4)
    expected = scipy.spatial.transform.Rotation.from_quat(quaternion).as_matrix()
    np.testing.assert_allclose(head_transform.rotation_matrix(quaternion), expected, atol=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_rotations_in_other_axes_are_the_conjugates(seed):
    quaternion = np.random.default_rng(seed).normal(size=(1, 4))
    axes = head_transform.face_axes("z")
    turned = head_transform.turned_quaternions(quaternion, axes)[0]
    expected = axes @ head_transform.rotation_matrix(quaternion[0]) @ axes.T
    np.testing.assert_allclose(head_transform.rotation_matrix(turned), expected, atol=1e-12)


def test_a_nod_is_a_nod_whichever_axis_points_up():
    """With z up the face looks along -y; both times the nose (in front) goes down in a nod."""
    nod = np.array([[np.sin(0.2), 0, 0, np.cos(0.2)]])
    for up, ahead, above in (("y", [0, 0, 1], [0, 1, 0]), ("z", [0, -1, 0], [0, 0, 1])):
        axes = head_transform.face_axes(up)
        rotation = head_transform.rotation_matrix(head_transform.turned_quaternions(nod, axes)[0])
        moved = head_transform.apply(
            np.array([ahead], float), rotation, np.zeros(3), 1.0, np.zeros(3)
        )
        assert moved[0] @ above < -0.3
        np.testing.assert_allclose(axes @ [0, 0, 1], ahead)
        np.testing.assert_allclose(axes @ [0, 1, 0], above)
        np.testing.assert_allclose(axes @ [1, 0, 0], [1, 0, 0])


def test_the_pivot_stays_where_it_is_but_for_the_translation():
    pivot, shift = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.0, -0.2])
    rotation = head_transform.rotation_matrix(np.array([0.1, 0.5, -0.2, 0.8]))
    moved = head_transform.apply(pivot[None], rotation, shift, 1.7, pivot)
    np.testing.assert_allclose(moved[0], pivot + shift, atol=1e-12)


def test_what_is_no_rotation_or_axis_is_refused():
    with pytest.raises(ValueError, match="no rotation"):
        head_transform.rotation_matrix(np.zeros(4))
    with pytest.raises(ValueError, match="none of y, z"):
        head_transform.face_axes("x")
