import itertools

import marker_face
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import (
    face_alignment,
    marker_faults,
    marker_gaps,
    marker_repair,
    marker_statistics,
    two_state_path,
)


def distance(points, truth):
    return np.sqrt(((points - truth) ** 2).sum(axis=-1).mean())


def test_the_heads_motion_is_found_in_spite_of_faults_and_gaps():
    truth, take = marker_face.take(noise=0.0)
    take[100:160, 3] += [15, 0, 0]
    take[40:500, 7] = np.nan
    motion = face_alignment.align(take)
    still = face_alignment.align(truth)
    np.testing.assert_allclose(np.linalg.det(motion.rotation), 1)
    apart = np.einsum("tij,tik->tjk", motion.rotation, still.rotation)
    # the two median faces may differ by a turn of their own
    apart = apart @ apart[0].T
    assert np.abs(apart - np.eye(3)).max() < 0.01
    back = face_alignment.from_face(face_alignment.to_face(take, motion), motion)
    np.testing.assert_allclose(back, take, atol=1e-9)


def test_a_frame_with_three_markers_has_no_motion_and_too_few_are_refused():
    _, take = marker_face.take(count=50)
    take[20, 3:] = np.nan
    motion = face_alignment.align(take)
    assert np.isnan(motion.rotation[20]).all()
    assert np.isfinite(np.delete(motion.rotation, 20, axis=0)).all()
    with pytest.raises(ValueError, match=r"no frame of \(50, 2, 3\) holds 4 points"):
        face_alignment.align(take[:, :2])


def test_predictions_are_those_of_the_conditional_gaussian():
    rng = np.random.default_rng(3)
    mixing = rng.standard_normal((12, 12))
    frames = (rng.standard_normal((500, 12)) @ mixing).reshape(500, 4, 3)
    model = marker_statistics.fit(frames)
    expected = marker_statistics.predict_each(model, frames)
    for marker in range(4):
        others = np.delete(np.arange(4), marker)
        matrix = marker_statistics.predictor(model, marker, others)
        offset = (frames - model.mean)[:, others].reshape(500, -1)
        np.testing.assert_allclose(
            expected[:, marker], model.mean[marker] + offset @ matrix.T, atol=1e-8
        )
    gappy = frames.copy()
    gappy[:250, 2] = np.nan
    completed = marker_statistics.complete(model, gappy)
    np.testing.assert_allclose(completed[:250, 2], expected[:250, 2], atol=1e-8)
    np.testing.assert_array_equal(completed[250:], frames[250:])


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(1, 7), st.floats(0.1, 5))
def test_the_path_is_the_cheapest_of_all(seed, count, switch):
    rng = np.random.default_rng(seed)
    doubt, step = rng.normal(0, 3, (count, 2)), rng.exponential(4, (count, 2))

    def cost(states, p):
        total = switch if states[0] else doubt[0, p]
        for t in range(1, count):
            total += 0 if states[t] else doubt[t, p]
            if states[t] != states[t - 1]:
                total += switch
            else:
                capped = min(step[t, p], two_state_path.LEAP * switch)
                total += capped if states[t] else step[t, p]
        return total

    states = two_state_path.trace(doubt, step, switch)
    for p in range(2):
        best = min(cost(s, p) for s in itertools.product((False, True), repeat=count))
        assert cost(states[:, p], p) == pytest.approx(best)


@pytest.mark.parametrize("noise", [0.05, 0.3])
def test_a_clean_take_has_no_faults(noise):
    _, take = marker_face.take(seed=5, noise=noise)
    assert (marker_repair.repair(take.astype(np.float32), 60).repaired == 0).all()


def test_planted_faults_are_found_and_repaired():
    truth, take = marker_face.take(seed=2)
    planted = np.zeros(take.shape[:2], bool)
    rng = np.random.default_rng(1)
    for number, (first, length) in enumerate([(50, 1), (200, 8), (420, 90), (700, 200)]):
        marker = 3 * number + 1
        away = rng.standard_normal(3)
        take[first : first + length, marker] += rng.uniform(6, 15) * away / np.linalg.norm(away)
        planted[first : first + length, marker] = True
    swapped = slice(900, 960)
    take[swapped, [8, 14]] = take[swapped, [14, 8]]
    planted[swapped, [8, 14]] = True
    result = marker_repair.repair(take, 100)
    np.testing.assert_array_equal(result.repaired == marker_repair.MISTAKEN, planted)
    assert {(f.marker, f.first, f.last, f.partner) for f in result.faults} == {
        (1, 50, 50, -1),
        (4, 200, 207, -1),
        (7, 420, 509, -1),
        (10, 700, 899, -1),
        (8, 900, 959, 14),
        (14, 900, 959, 8),
    }
    assert np.isnan(result.points[700:900, 10]).all()  # longer than what is filled
    replaced = planted & np.isfinite(result.points[..., 0])
    assert distance(result.points[replaced], truth[replaced]) < 0.4
    np.testing.assert_array_equal(result.points[~planted], take[~planted])
    np.testing.assert_array_equal(result.points[swapped, 8], take[swapped, 14])


def test_a_marker_that_comes_back_in_the_wrong_place_is_found():
    truth, take = marker_face.take(seed=4)
    take[300:310, 6] = np.nan
    take[310:340, 6] += [0, 9, 0]
    take[340:350, 6] = np.nan
    result = marker_repair.repair(take, 100)
    assert (result.repaired[310:340, 6] == marker_repair.MISTAKEN).all()
    assert (result.repaired[300:310, 6] == marker_repair.FILLED).all()
    assert (np.delete(result.repaired, 6, axis=1) == 0).all()
    assert distance(result.points[300:350, 6], truth[300:350, 6]) < 0.4


def test_gaps_are_filled_better_than_by_a_line_and_without_a_step():
    truth, take = marker_face.take(seed=7)
    gappy, rng = take.copy(), np.random.default_rng(0)
    gaps = [(m, int(rng.integers(2, 1150)), int(rng.integers(1, 41))) for m in range(0, 24, 2)]
    gaps[:2] = [(0, 0, 30), (2, 1180, 20)]  # at both ends of the take
    for marker, first, length in gaps:
        gappy[first : first + length, marker] = np.nan
    result = marker_repair.repair(gappy, 40)
    assert np.isfinite(result.points).all()
    lost = np.isnan(gappy[..., 0])
    np.testing.assert_array_equal(result.repaired, np.where(lost, marker_repair.FILLED, 0))
    assert distance(result.points[lost], truth[lost]) < 0.25
    line = gappy.copy()
    for marker in range(24):
        seen = np.flatnonzero(~lost[:, marker])
        for axis in range(3):
            line[:, marker, axis] = np.interp(np.arange(1200), seen, take[seen, marker, axis])
    assert distance(result.points[lost], truth[lost]) < 0.1 * distance(line[lost], truth[lost])
    steps, true_steps = (np.linalg.norm(np.diff(p, axis=0), axis=2) for p in (result.points, truth))
    assert (steps < true_steps + 1.5).all()


def test_long_gaps_and_frames_without_others_stay_open():
    _, take = marker_face.take(count=400)
    take[100:131, 2] = np.nan
    take[200:230, 5] = np.nan
    take[300:310] = np.nan
    result = marker_repair.repair(take, 30)
    assert np.isnan(result.points[100:131, 2]).all()
    assert np.isfinite(result.points[200:230, 5]).all()
    assert np.isnan(result.points[300:310]).all()
    assert (result.repaired[200:230, 5] == marker_repair.FILLED).all()
    assert (result.repaired[300:310] == 0).all()
    assert len(result.gaps) == 24 + 2


def test_too_few_markers_are_left_alone():
    _, take = marker_face.take(count=60)
    take = take[:, :3].copy()
    take[10:20, 0] = np.nan
    result = marker_repair.repair(take, 30)
    np.testing.assert_array_equal(result.points, take)
    assert [tuple(gap) for gap in result.gaps] == [(0, 10, 19)]


def test_drift_is_told_from_noise():
    rng = np.random.default_rng(0)
    slow = 1.5 * marker_face.smooth(rng, 6000, 3, 30)
    drift = marker_gaps.drift_of(slow + 0.2 * rng.standard_normal(slow.shape))
    assert drift.noise == pytest.approx(0.04, rel=0.5)
    assert drift.size == pytest.approx(2.25, rel=0.5)
    frames = np.array([-2, -1, 10, 11])
    steady = np.ones((4, 3))
    made, unsure = marker_gaps.bridge(frames, steady, np.arange(10), drift)
    assert 0.7 < made.min() <= made.max() < 1.1
    assert 0 < unsure < np.sqrt(drift.size)
    nothing, most = marker_gaps.bridge(frames[:0], steady[:0], np.arange(10), drift)
    assert not nothing.any()
    assert most == pytest.approx(np.sqrt(drift.size))


def test_steps_do_not_count_motion_and_bridge_gaps():
    away = np.zeros((40, 2, 3))
    away[:, 0, 0] = 2.0 * np.arange(40)
    away[20:, 1, 1] = 5.0
    away[10:14, 1] = np.nan
    away[14:, 1, 2] = 3.0
    steps = marker_faults.sudden_steps(away)
    assert steps[3:37, 0].max() < 4
    assert steps[20, 1] == pytest.approx(5)
    assert steps[14, 1] == pytest.approx(3 / np.sqrt(5))
    assert np.isnan(steps[10:14, 1]).all()
