import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import coverage


def _drawn(seed, examples=12, frames=80, count=3):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(examples, count)), rng.normal(size=(frames, count))


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000), st.floats(0.01, 100))
def test_leverage_is_the_variance_of_a_ridge_map_and_has_no_scale(seed, scale):
    examples, frames = _drawn(seed)
    reach = coverage.leverage(examples, frames, 1e-9)
    centre = frames.mean(axis=0)
    lifted = np.column_stack([np.ones(len(examples)), examples - centre])
    rows = np.column_stack([np.ones(len(frames)), frames - centre])
    covariance = np.linalg.pinv(lifted) @ np.linalg.pinv(lifted).T
    np.testing.assert_allclose(reach, np.einsum("ti,ij,tj->t", rows, covariance, rows), rtol=1e-4)
    np.testing.assert_allclose(
        coverage.leverage(scale * examples + 7, scale * frames + 7),
        coverage.leverage(examples, frames),
    )


def test_examples_cover_themselves_and_a_far_frame_is_outside():
    examples, _ = _drawn(1)
    assert coverage.uncovered_share(examples, examples) == 0
    frames = np.vstack([examples, 20 * np.eye(3)])
    assert coverage.uncovered_share(examples, frames) == pytest.approx(3 / 15)
    assert coverage.uncovered_share(np.zeros((0, 3)), frames) == 1


def test_tuning_the_next_frames_covers_the_take():
    _, frames = _drawn(2)
    eligible = np.ones(len(frames), bool)
    eligible[5] = False
    frames[5] = 50
    chosen = coverage.next_frames(np.zeros((0, 3)), frames, eligible, 10)
    assert len(set(chosen)) == 10
    assert 5 not in chosen
    shares = [
        coverage.uncovered_share(frames[chosen[:n]], np.delete(frames, 5, 0)) for n in (1, 10)
    ]
    assert shares[0] > 0.5 > shares[1]


def test_each_choice_is_the_best_of_a_full_search():
    examples, frames = _drawn(3, examples=4, frames=30)
    chosen = coverage.next_frames(examples, frames, np.ones(30, bool), 3, 0.1)
    held, left = examples, np.ones(30)
    for row in chosen:
        assert row == (left * coverage.leverage(held, frames, 0.1)).argmax()
        left[row] = 0
        held = np.vstack([held, frames[row]])


def test_fewer_eligible_frames_than_asked():
    examples, frames = _drawn(4)
    eligible = np.arange(len(frames)) < 3
    assert sorted(coverage.next_frames(examples, frames, eligible, 9)) == [0, 1, 2]


def test_unlike_coordinates_are_refused():
    with pytest.raises(ValueError, match=r"\(2, 3\).*\(4, 2\)"):
        coverage.leverage(np.zeros((2, 3)), np.zeros((4, 2)))
    with pytest.raises(ValueError, match="positive ridge"):
        coverage.leverage(np.zeros((2, 3)), np.zeros((4, 3)), 0.0)
