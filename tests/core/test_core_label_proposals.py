import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import label_proposals


def tracked(seed, frames=80, points=6):
    rng = np.random.default_rng(seed)
    half = frames // 2
    return label_proposals.Tracked(
        shot=np.repeat([0, 1], [half, frames - half]),
        time_s=np.concatenate([np.arange(half), np.arange(frames - half)]) / 10,
        points=rng.normal(0, 1, (frames, points, 2)) + 20 * rng.normal(size=(points, 2)),
        confidence=rng.uniform(0.5, 1, (frames, 3)),
        residual=rng.uniform(0.9, 1.1, frames),
    )


@given(st.integers(0, 2**31), st.integers(0, 12))
def test_labelled_frames_and_repetitions_are_never_proposed(seed, count):
    frames = tracked(seed)
    labelled = np.random.default_rng(seed).random(80) < 0.2
    chosen = label_proposals.rank(frames, labelled, count)
    assert len(chosen) == len(set(chosen)) <= count
    assert not labelled[chosen].any()


def test_the_most_doubtful_frame_comes_first_and_its_neighbours_do_not_follow():
    frames = tracked(1)
    frames.confidence[:] = 0.9
    frames.confidence[18:23, 1] = 0.05
    frames.confidence[60, 2] = 0.4
    chosen = label_proposals.rank(frames, np.zeros(80, bool), 2)
    assert 18 <= chosen[0] < 23
    assert chosen[1] == 60


def test_a_frame_beside_a_labelled_one_yields_to_a_far_one():
    frames = tracked(2)
    frames.confidence[:] = 0.95
    frames.confidence[[10, 30], 0] = [0.1, 0.3]
    labelled = np.zeros(80, bool)
    labelled[11] = True
    assert label_proposals.rank(frames, labelled, 1) == [30]


def test_a_picture_unlike_the_others_is_proposed():
    frames = tracked(3)
    frames.confidence[:] = 0.95
    frames.residual[47] = 2.5
    assert label_proposals.rank(frames, np.zeros(80, bool), 1) == [47]


def test_a_run_without_a_face_is_proposed_once():
    frames = tracked(4)
    frames.confidence[:] = 0.97
    frames.points[5:20] = np.nan
    frames.confidence[5:20] = 0
    frames.residual[5:20] = np.nan
    chosen = label_proposals.rank(frames, np.zeros(80, bool), 3)
    assert 5 <= chosen[0] < 20
    assert sum(5 <= t < 20 for t in chosen) == 1


def test_nothing_is_proposed_where_nothing_is_in_doubt():
    frames = tracked(5)
    frames.confidence[:] = 1.0
    frames.residual[:] = 1.0
    assert label_proposals.rank(frames, np.zeros(80, bool), 5) == []


def test_a_session_without_any_face_still_ranks():
    frames = tracked(6)
    frames.points[:] = np.nan
    frames.residual[:] = np.nan
    assert label_proposals.rank(frames, np.zeros(80, bool), 4) == [0, 40]


def test_flags_of_another_length_are_refused():
    with pytest.raises(ValueError, match="79 labelled flags for 80 frames"):
        label_proposals.rank(tracked(7), np.zeros(79, bool), 1)
