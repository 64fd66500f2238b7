import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import contours


def circle(count, start=0.0):
    turn = start + np.linspace(0, 2 * np.pi, count, endpoint=False)
    return 50 + 20 * np.stack([np.cos(turn), np.sin(turn)], axis=1)


@given(st.integers(2, 30), st.integers(0, 2**31))
def test_open_contour_is_even_in_arc_length(count, seed):
    steps = np.random.default_rng(seed).uniform(0.1, 5, 12)
    line = np.stack([np.concatenate([[0], np.cumsum(steps)]), np.zeros(13)], axis=1)
    found = contours.resample(line, False, (), count)
    assert found == pytest.approx(np.linspace(line[0], line[-1], count))


@given(st.integers(4, 40))
def test_corners_of_a_closed_contour_stay(count):
    points = circle(90)
    found = contours.resample(points, True, (10, 40), count)
    assert found[0] == pytest.approx(points[10])
    assert found[-(-count // 2)] == pytest.approx(points[40])
    assert len(found) == count


def test_each_stretch_is_even_and_keeps_its_share_when_another_grows():
    points = circle(360)
    wide = contours.resample(points, True, (0, 60), 12)
    gaps = np.linalg.norm(np.diff(np.vstack([wide, wide[:1]]), axis=0), axis=1)
    assert np.ptp(gaps[:6]) < 1e-3 * gaps[0]
    assert np.ptp(gaps[6:]) < 0.03 * gaps[6]
    assert gaps[6] > 3 * gaps[0]


def test_the_result_does_not_depend_on_where_the_labelling_began():
    points = circle(60)
    turned = np.roll(points, 7, axis=0)
    first = contours.resample(points, True, (5, 30), 17)
    assert contours.resample(turned, True, (12, 37), 17) == pytest.approx(first)


def test_already_even_points_stay_where_they_are():
    line = np.stack([np.arange(7.0), np.zeros(7)], axis=1)
    assert contours.resample(line, False, (), 7) == pytest.approx(line)


def test_inner_corners_of_an_open_contour_stay():
    line = np.array([[0.0, 0], [4, 0], [4, 1]])
    found = contours.resample(line, False, (1,), 5)
    assert found == pytest.approx(np.array([[0, 0], [2, 0], [4, 0], [4, 0.5], [4, 1]]))


def test_a_closed_contour_without_corner_is_refused():
    with pytest.raises(ValueError, match="needs a corner"):
        contours.resample(circle(10), True, (), 5)


def test_fewer_points_than_stretches_are_refused():
    with pytest.raises(ValueError, match="3 stretches"):
        contours.resample(circle(10), True, (0, 3, 6), 2)
