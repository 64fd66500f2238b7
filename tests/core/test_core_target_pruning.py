import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import local_shapes, target_pruning


def drawn(seed, frames, count):
    rng = np.random.default_rng(seed)
    weights = np.maximum(rng.normal(size=(frames, count)), 0)
    return weights, rng.uniform(0.1, 2, count)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.integers(1, 9), st.integers(1, 9))
def test_no_more_are_active_at_once_at_frames_and_between(seed, frames, count, most):
    weights, reach = drawn(seed, frames, count)
    active = target_pruning.kept(weights, reach, most) & (weights > 0)
    assert (active.sum(axis=1) <= most).all()
    between = active[:-1] | active[1:]
    assert (between.sum(axis=1) <= most).all()
    if most >= count:
        np.testing.assert_array_equal(active, weights > 0)


def test_what_moves_the_face_most_stays():
    weights = np.tile([0.9, 0.5, 0.1], (4, 1))
    kept = target_pruning.kept(weights, np.array([0.1, 1.0, 3.0]), 2)
    np.testing.assert_array_equal(kept, np.tile([False, True, True], (4, 1)))


def test_the_worst_error_is_that_of_the_sum_of_what_is_left_out():
    rng = np.random.default_rng(3)
    deltas = rng.normal(size=(4, 7, 3)) * (rng.uniform(size=(4, 7, 1)) < 0.6)
    targets = local_shapes.gather(deltas)
    dropped, scale = rng.uniform(size=(5, 4)), rng.uniform(0.5, 2, 5)
    moved = np.einsum("tm,mvd->tvd", dropped, deltas) * scale[:, None, None]
    wanted = np.linalg.norm(moved, axis=2).max()
    assert target_pruning.worst_error(targets, dropped, scale) == pytest.approx(wanted)
    assert target_pruning.worst_error(targets, np.zeros((5, 4)), scale) == 0
    longest = np.linalg.norm(deltas, axis=2).max(axis=1)
    np.testing.assert_allclose(target_pruning.reach(targets), longest)


def test_forms_that_do_not_fit_are_named():
    with pytest.raises(ValueError, match=r"keep 0 of weights \(2, 3\), reach \(3,\)"):
        target_pruning.kept(np.zeros((2, 3)), np.zeros(3), 0)
    with pytest.raises(ValueError, match=r"reach \(2,\)"):
        target_pruning.kept(np.zeros((2, 3)), np.zeros(2), 1)
