import numpy as np
import pytest

from stages.core import between_poses, gap_features, whole_parts

RATE = 30.0


def performed(seed, frames=1500, channels=6):
    """Return curves that rest, move smoothly and rest again, several at once, as faces do."""
    rng = np.random.default_rng(seed)
    mixing = np.random.default_rng(99).normal(size=(3, channels))
    made = np.zeros((frames, 3))
    pose, at = rng.uniform(0, 1, 3), 0
    while at < frames:
        hold, move = rng.integers(5, 25), rng.integers(8, 24)
        target = rng.uniform(0, 1, 3)
        made[at : at + hold] = pose
        at += hold
        ease = (1 - np.cos(np.pi * np.arange(1, move + 1) / (move + 1))) / 2
        here = made[at : at + move]
        here[:] = (pose + ease[:, None] * (target - pose))[: len(here)]
        pose, at = target, at + move
    return made @ mixing


def holes(frames, length, step=70):
    return [slice(first, first + length) for first in range(40, frames - length - 40, step)]


@pytest.fixture(scope="module")
def model():
    return between_poses.learn([performed(0, 900), performed(1, 900)], [RATE, RATE])


@pytest.mark.parametrize(("length", "share"), [(3, 0.5), (5, 0.6), (15, 0.85), (30, 0.98)])
def test_whole_frames_come_back_better_than_by_straight_lines(model, length, share):
    truth = performed(2)
    spoilt = truth.copy()
    for hole in holes(len(truth), length):
        spoilt[hole] = np.nan
    made = between_poses.fill(model, spoilt, RATE)
    lost = np.isnan(spoilt)
    np.testing.assert_array_equal(made[~lost], truth[~lost])
    rows = np.arange(len(truth))
    straight = np.stack(
        [
            np.interp(rows, rows[~gone], one[~gone])
            for one, gone in zip(truth.T, lost.T, strict=True)
        ],
        1,
    )
    assert np.std((made - truth)[lost]) < share * np.std((straight - truth)[lost])


def test_channels_that_were_seen_tell_the_others(model):
    truth = performed(3)
    spoilt = truth.copy()
    for hole in holes(len(truth), 30):
        spoilt[hole, :2] = np.nan
    made = between_poses.fill(model, spoilt, RATE)
    lost = np.isnan(spoilt)
    assert np.std((made - truth)[lost]) < 0.1 * np.std(truth[lost])


def test_nothing_jumps_at_the_ends(model):
    truth = performed(4)
    spoilt = truth.copy()
    for hole in holes(len(truth), 12):
        spoilt[hole, :4] = np.nan
    made = between_poses.fill(model, spoilt, RATE)
    usual = np.abs(np.diff(truth, axis=0)).max()
    assert np.abs(np.diff(made, axis=0)).max() < 1.6 * usual


def test_the_rate_of_a_take_does_not_matter(model):
    rows = np.arange(1500)
    fine_rows = np.arange(4 * 1499 + 1) / 4
    slow = performed(5)
    fast = np.stack([np.interp(fine_rows, rows, one) for one in slow.T], axis=1)
    for hole in holes(1500, 11, 140):
        slow[hole] = np.nan
        fast[4 * hole.start - 3 : 4 * hole.stop] = np.nan
    made = between_poses.fill(model, slow, RATE)
    finer = between_poses.fill(model, fast, 4 * RATE)
    np.testing.assert_allclose(finer[::4], made, atol=1e-9)


def test_larger_motion_is_filled_alike(model):
    """Features grow with the curves, so twice the motion is filled by twice the motion."""
    spoilt = performed(6, 300)
    spoilt[100:110] = np.nan
    wide = model._replace(low=model.low - 99, high=model.high + 99)
    once = between_poses.fill(wide, spoilt, RATE)
    np.testing.assert_allclose(between_poses.fill(wide, 2 * spoilt, RATE), 2 * once, atol=1e-9)


def test_what_is_filled_stays_in_range(model):
    spoilt = performed(7, 400)
    for hole in holes(400, 20, 60):
        spoilt[hole] = np.nan
    made = between_poses.fill(model, spoilt, RATE, 0.2, np.full(6, 0.3))
    lost = np.isnan(spoilt)
    assert made[lost].min() >= 0.2
    assert made[lost].max() <= 0.3
    free = between_poses.fill(model, spoilt, RATE)
    low = np.minimum(model.low, np.nanmin(spoilt, axis=0))
    assert (free >= low - 1e-12).all()


def test_ends_are_held_and_neighbouring_gaps_filled(model):
    spoilt = performed(8, 200)
    truth = spoilt.copy()
    spoilt[:7], spoilt[-4:, 2] = np.nan, np.nan
    # gaps that leave one frame between them, and one that overlaps another channel's
    spoilt[50:60], spoilt[61:70], spoilt[100:120, 0], spoilt[110:130, 1] = [np.nan] * 4
    made = between_poses.fill(model, spoilt, RATE)
    assert np.isfinite(made).all()
    np.testing.assert_array_equal(made[:7], np.repeat(truth[7:8], 7, axis=0))
    np.testing.assert_array_equal(made[-4:, 2], truth[[-5], 2].repeat(4))
    assert np.abs(made - truth)[100:130].max() < 0.3


def test_a_take_with_gaps_is_learnt_from():
    take = performed(0, 500)
    for hole in holes(len(take), 9, 150):
        take[hole, 3] = np.nan
    model = between_poses.learn([take], [RATE])
    assert np.isfinite(model.coefficients).all()
    assert np.isfinite(model.deviations).all()


def test_what_does_not_fit_is_refused(model):
    with pytest.raises(ValueError, match="too few stretches"):
        between_poses.learn([performed(0, 20)], [RATE])
    with pytest.raises(ValueError, match="do not belong together"):
        between_poses.learn([performed(0), performed(0, channels=4)], [RATE, RATE])
    with pytest.raises(ValueError, match="6 channels learnt"):
        between_poses.fill(model, np.zeros((9, 5)), RATE)
    unseen = performed(0)
    unseen[:, 2] = np.nan
    with pytest.raises(ValueError, match="channel 2 of .* never observed"):
        between_poses.fill(model, unseen, RATE)


def test_slopes_are_those_of_a_line():
    time = np.arange(40)[:, None] / 24.0
    values = np.hstack([3 * time, -time])
    for side in (-1, 1):
        made = gap_features.slopes(values, 20, side, 24.0)
        np.testing.assert_allclose(made, np.tile([3.0, -1.0], (3, 1)))
    values[:19] = np.nan
    made = gap_features.slopes(values, 19, -1, 24.0)
    np.testing.assert_array_equal(made, np.zeros((3, 2)))


def test_parts_of_a_whole_stay_parts():
    before = np.array([[0.5, 0.5, 0.4], [0.2, 0.3, 0.9], [np.nan, 0.1, 0.2]])
    values = np.array([[0.8, 0.4, 0.5], [-0.1, 0.3, 1.2], [0.5, 0.6, 0.7]])
    made = whole_parts.limited(values, before, np.array([0, 0, 1]))
    expected = [[0.8 / 1.2, 0.4 / 1.2, 0.5], [0, 0.3, 0.9], [0.5 / 1.1, 0.6 / 1.1, 0.7]]
    np.testing.assert_allclose(made, expected)
    made = whole_parts.limited(values - 1, before - 1, np.array([0, 0, 1]))
    np.testing.assert_array_equal(made >= np.nanmin(before - 1, axis=0), True)
