from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import film_frames, frame_clock, regular_frames

rates = st.sampled_from(frame_clock.STANDARD)


def drawn_times(rate, count, seed, lost, digits):
    """Times of a take that starts anywhere, rounded, some frames lost but not the ends."""
    rng = np.random.default_rng(seed)
    kept = rng.random(count) >= lost
    kept[[0, -1]] = True
    frames = np.arange(count)
    return np.round(frames[kept] / float(rate) + 7.125, digits), frames[kept]


@given(rates, st.integers(0, 99), st.sampled_from([0.0, 0.02, 0.2]), st.sampled_from([3, 4, 9]))
@settings(deadline=None)
def test_rates_are_found_in_rounded_times_with_drops(rate, seed, lost, digits):
    times, frames = drawn_times(rate, 3 * int(rate) + 5, seed, lost, digits)
    assert frame_clock.rate_of(times) == rate
    assert frame_clock.rate_of(times, frames) == rate
    np.testing.assert_array_equal(frame_clock.numbers(times, rate), frames)
    for unit in (1e3, 1e6):
        np.testing.assert_allclose(frame_clock.seconds(times * unit), times, rtol=1e-12)
    np.testing.assert_array_equal(frame_clock.seconds(times), times)


def test_rates_that_are_not_standard_or_not_plausible():
    assert frame_clock.snapped(14.7) == Fraction(147, 10)
    assert frame_clock.snapped(29.97) == Fraction(30000, 1001)
    for times, fault in (
        ([0, 0.001, 0.002], "its times step by 0.001 s"),
        ([0, 0.04, 0.04], "time 0.04 s follows 0.04 s"),
        ([0, np.nan, 1], "follows"),
        ([0], "one frame alone"),
    ):
        with pytest.raises(ValueError, match=fault):
            frame_clock.rate_of(np.array(times))
    with pytest.raises(ValueError, match="fall on one frame at 25/s"):
        frame_clock.numbers(np.array([0, 0.04, 0.05]), Fraction(25))
    with pytest.raises(ValueError, match="3 rows stand for 100000 frames"):
        frame_clock.check_span(3, 100000)


@given(rates, st.integers(0, 99), st.sampled_from([0.0, 0.05, 0.3]))
@settings(deadline=None)
def test_rows_come_back_on_their_frames_and_gaps_are_straight(rate, seed, lost):
    count = 2 * int(rate) + 3
    times, frames = drawn_times(rate, count, seed, lost, 9)
    # straight lines, so that what is filled is known too
    truth = np.arange(count)[:, None] * [1.0, -2.5] + [3.0, 0.0]
    values, measured = regular_frames.regular(truth[frames], times, rate)
    np.testing.assert_array_equal(values[frames], truth[frames])
    np.testing.assert_allclose(values, truth, atol=1e-9)
    np.testing.assert_array_equal(np.flatnonzero(measured), frames)


def test_a_clock_that_runs_fast_does_not_drift():
    rate, count = Fraction(30), 4000
    times = np.arange(count) / 30.01 + 100
    values, measured = regular_frames.regular(np.sin(4 * times)[:, None], times, rate)
    assert measured.all() and len(values) == 3999
    wanted = 100 + np.arange(3999) / 30
    np.testing.assert_allclose(values[:-2, 0], np.sin(4 * wanted[:-2]), atol=3e-5)
    # a tenth of that drift is within the slack, and nothing is interpolated
    values, _ = regular_frames.regular(times[:, None], 100 + (times - 100) * 1.0003, rate)
    np.testing.assert_array_equal(values[:, 0], times)


def test_blank_rows_are_filled_but_not_measured():
    values = np.array([[1.0, 1], [np.nan, 1], [3, 3]])
    found, measured = regular_frames.regular(values, np.array([0, 0.04, 0.08]), Fraction(25))
    np.testing.assert_allclose(found, [[1, 1], [2, 2], [3, 3]])
    assert measured.tolist() == [True, False, True]
    with pytest.raises(ValueError, match="no frame without blanks"):
        regular_frames.regular(values * np.nan, np.array([0, 0.04, 0.08]), Fraction(25))
    with pytest.raises(ValueError, match="stand for"):
        regular_frames.regular(values, np.array([0, 0.04, 1e9]), Fraction(25))


PICTURES = np.arange(10) / 25


def on_film(frame=None, first=0, time_s=None, count=0):
    frame = None if frame is None else np.array(frame)
    time_s = None if time_s is None else np.array(time_s)
    count = count or len(frame if frame is not None else time_s)
    return film_frames.on_film(PICTURES, count, frame, first, time_s)


@pytest.mark.parametrize(
    ("given_rows", "row"),
    [
        ({"frame": range(10)}, range(10)),
        ({"frame": range(1, 11)}, range(10)),
        ({"frame": range(1, 11), "first": 1}, range(10)),
        ({"frame": range(1, 9), "first": None}, [*range(8), -1, -1]),
        ({"frame": [1, 2, 4, 5], "time_s": [0, 0.04, 0.12, 0.16]}, [0, 1, -1, 2, 3, *[-1] * 5]),
        ({"frame": [2, 3, 5]}, [-1, -1, 0, 1, -1, 2, *[-1] * 4]),
        ({"time_s": [0.05, 0.081, 0.16]}, [-1, 0, 1, -1, 2, *[-1] * 5]),
        ({"count": 10}, range(10)),
    ],
)
def test_rows_find_their_pictures(given_rows, row):
    placed = on_film(**given_rows)
    np.testing.assert_array_equal(placed.row, list(row))
    np.testing.assert_array_equal(placed.frame, np.arange(10))
    np.testing.assert_array_equal(placed.time_s, PICTURES)


def test_rows_of_every_second_picture_leave_no_gaps():
    placed = on_film(frame=[1, 3, 5, 9], first=0, time_s=[0.04, 0.12, 0.20, 0.36])
    np.testing.assert_array_equal(placed.frame, [1, 3, 5, 7, 9])
    np.testing.assert_array_equal(placed.row, [0, 1, 2, -1, 3])


@pytest.mark.parametrize(
    ("given_rows", "fault"),
    [
        ({"frame": [0, 11]}, "has frames 0 to 11, the film 0 to 9"),
        ({"frame": [0, 3], "first": 1}, "has frames 0 to 3, the film 1 to 10"),
        ({"time_s": [0.0, 0.4, 0.8]}, r"has times 0.000 to 0.800 s, the film 0 to 0.360 s"),
        ({"time_s": [0.0, 0.001]}, "mean the same picture"),
        ({"count": 7}, "has 7 rows without frame numbers, the film 10 pictures"),
    ],
)
def test_rows_of_another_film_are_refused(given_rows, fault):
    with pytest.raises(ValueError, match=fault):
        on_film(**given_rows)


def test_rows_without_a_film_keep_their_times_and_gaps():
    rate = Fraction(25)
    times = np.array([50.08, 50.121, 50.2])
    placed, found = film_frames.alone(3, np.array([2, 3, 5]), 0, times, None)
    assert found == rate
    np.testing.assert_array_equal(placed.row, [-1, -1, 0, 1, -1, 2])
    np.testing.assert_allclose(placed.time_s, [0, 0.04, 0.08, 0.121, 0.1605, 0.2])
    unnumbered = np.array([50.08, 50.121, 50.16, 50.24])
    placed, _ = film_frames.alone(4, None, 0, unnumbered, None)
    np.testing.assert_array_equal(placed.row, [0, 1, 2, -1, 3])
    np.testing.assert_allclose(placed.time_s, [0, 0.041, 0.08, 0.12, 0.16])
    placed, _ = film_frames.alone(3, np.array([2, 3, 5]), 0, None, Fraction(50))
    np.testing.assert_allclose(placed.time_s[-1], 0.1)
    for frame, first, fault in (
        (np.array([0, 1, 50000]), 0, "3 rows stand for 50001 frames"),
        (np.array([0, 1, 2]), 1, "has frame 0 before the first, 1"),
    ):
        with pytest.raises(ValueError, match=fault):
            film_frames.alone(3, frame, first, None, rate)
    with pytest.raises(ValueError, match="neither times nor a rate"):
        film_frames.alone(3, None, 0, None, None)
