import numpy as np
import pytest
import scipy.interpolate

from stages.core import local_trend

RATE = 60.0


def moving(frames=600, rate=RATE):
    time = np.arange(frames) / rate
    slow = 0.5 + 0.4 * np.sin(2 * np.pi * 0.5 * time)
    fast = 0.5 + 0.3 * np.sin(2 * np.pi * 3.0 * time)
    return np.column_stack([slow, fast])


def nothing(columns):
    return np.zeros((len(local_trend.RATIOS), columns))


def test_jitter_goes_and_motion_stays():
    truth = moving()
    noisy = truth + 0.02 * np.random.default_rng(0).standard_normal(truth.shape)
    made = local_trend.smooth(noisy, RATE, nothing(2), np.ones(2))
    left = np.std(made - truth, axis=0)
    assert left[0] < 0.35 * 0.02
    assert left[1] < 0.65 * 0.02
    slope = np.polyfit(truth[:, 1], made[:, 1], 1)[0]
    assert slope == pytest.approx(1, abs=0.01)


def test_it_is_the_smoothing_spline_of_its_ratio(monkeypatch):
    """The spline that minimises sum |x - y|^2 + (r / q) int |y''|^2 (Kohn & Ansley)."""
    ratio = 1e5
    monkeypatch.setattr(local_trend, "RATIOS", np.array([ratio]))
    values = moving(400) + 0.02 * np.random.default_rng(1).standard_normal((400, 2))
    made = local_trend.smooth(values, RATE, np.zeros((1, 2)), np.ones(2))
    time = np.arange(400) / RATE
    for column, curve in zip(values.T, made.T, strict=True):
        spline = scipy.interpolate.make_smoothing_spline(time, column, lam=1 / ratio)
        np.testing.assert_allclose(curve[60:-60], spline(time)[60:-60], atol=1e-6)


def test_lines_and_constants_stay():
    time = np.arange(200)[:, None] / RATE
    values = np.hstack([0.3 * time + 1, np.full((200, 1), 0.25)])
    made = local_trend.smooth(values, RATE, nothing(2), np.ones(2))
    np.testing.assert_allclose(made, values, atol=1e-9)


def test_without_jitter_little_is_taken():
    truth = moving()
    made = local_trend.smooth(truth, RATE, nothing(2), np.ones(2))
    assert np.abs(made - truth).max() < 1e-3


def test_a_channel_can_be_left_alone_or_smoothed_more():
    noisy = moving() + 0.02 * np.random.default_rng(0).standard_normal((600, 2))
    made = local_trend.smooth(noisy, RATE, nothing(2), np.array([0.0, 1.0]))
    np.testing.assert_array_equal(made[:, 0], noisy[:, 0])
    more = local_trend.smooth(noisy, RATE, nothing(2), np.array([1.0, 100.0]))
    assert np.std(np.diff(more[:, 1], 2)) < np.std(np.diff(made[:, 1], 2))


def test_other_takes_decide_for_a_short_one():
    """A quarter of a second tells little; half a minute of the same tells how much is jitter."""
    rng = np.random.default_rng(2)
    truth = moving(1800)
    noisy = truth + 0.03 * rng.standard_normal(truth.shape)
    learnt = local_trend.learn([noisy[:900], noisy[900:]], [RATE, RATE])
    errors = {"alone": [], "told": []}
    for first in range(0, 1800, 90):
        part = slice(first, first + 15)
        for name, prior in (("alone", nothing(2)), ("told", learnt)):
            made = local_trend.smooth(noisy[part], RATE, prior, np.ones(2))
            errors[name].append(np.mean((made - truth[part]) ** 2))
    assert np.mean(errors["told"]) < np.mean(errors["alone"])


def test_what_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="do not belong together"):
        local_trend.smooth(np.zeros((9, 2)), RATE, nothing(3), np.ones(2))
    values = np.zeros((9, 2))
    values[3, 1] = np.nan
    with pytest.raises(ValueError, match="not all finite"):
        local_trend.smooth(values, RATE, nothing(2), np.ones(2))
    one = np.ones((1, 2))
    np.testing.assert_array_equal(local_trend.smooth(one, RATE, nothing(2), np.ones(2)), one)
