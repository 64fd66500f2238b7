import numpy as np
import pytest

from stages.core import expression_proposals


def test_missing_values_take_their_mean():
    values = np.array([[1.0, np.nan, np.nan], [3.0, 4.0, np.nan]])
    np.testing.assert_array_equal(
        expression_proposals.filled(values), [[1.0, 4.0, 0.0], [3.0, 4.0, 0.0]]
    )


def test_what_speech_moves_is_told_from_what_it_does_not():
    rng = np.random.default_rng(0)
    visemes = np.repeat(["m", "aa", "oo"], 30)
    values = 0.1 * rng.normal(size=(90, 4))
    values[:, :2] += np.repeat(rng.normal(size=(3, 2)), 30, axis=0)
    values[:, 2] += rng.normal(size=90)
    share = expression_proposals.told_apart(np.column_stack([values, np.ones(90)]), visemes)
    assert share[:2].min() > 0.95 and share[4] == 0
    assert share[2:4].max() < 0.85
    np.testing.assert_array_equal(expression_proposals.told_apart(values[:3], list("abc")), 1)


def test_the_typical_phone_is_long_and_in_the_midst():
    values = np.array([[0.0], [1.0], [1.1], [5.0], [1.2], [0.9], [8.0], [1.05]])
    lengths = np.array([0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.01, 0.01])
    assert expression_proposals.typical(values, lengths) == 2


def test_far_and_near_frames_are_eligible_ones():
    values = np.array([[9.0], [-4.0], [1.0], [0.1]])
    eligible = np.array([False, True, True, False])
    assert expression_proposals.farthest(values, eligible) == 1
    assert expression_proposals.nearest(values, eligible) == 2
    assert expression_proposals.nearest(values, eligible & False) is None
    assert expression_proposals.farthest(values, eligible & False) is None


@pytest.mark.parametrize("height", [0.0, 0.1, 0.5])
def test_the_opening_of_an_ellipse(height):
    angle = 2 * np.pi * np.arange(200) / 200
    eye = np.stack([np.cos(angle), height * np.sin(angle)], axis=1)
    turned = eye[::-1] * 3.0 + 7.0
    found = expression_proposals.opening_of_contour(np.stack([eye, turned]))
    np.testing.assert_allclose(found, np.pi * height / 4, atol=1e-3)


def test_eyes_open_half_and_closed_in_a_calm_face():
    rng = np.random.default_rng(0)
    opening = np.full(300, 1.0)
    for start in (50, 150, 250):
        opening[start : start + 9] = [0.8, 0.5, 0.2, 0, 0, 0, 0.2, 0.5, 0.8]
    opening += 0.01 * rng.normal(size=300)
    values = 0.1 * rng.normal(size=(300, 3))
    values[:140] += 2
    values[200:] += 2
    opening[7] = np.nan
    found = expression_proposals.blink_frames(opening, values, np.ones(300, bool), 0.5)
    assert found["half"] in (151, 157) and found["closed"] in (153, 154, 155)
    assert 140 <= found["open"] < 200 and abs(opening[found["open"]] - 1) < 0.1


def test_eyes_that_never_close_have_no_blink():
    opening = 1 + 0.2 * np.sin(np.arange(100))
    still = np.zeros((100, 2))
    every = np.ones(100, bool)
    assert expression_proposals.blink_frames(opening, still, every, 0.5) is None
    assert expression_proposals.blink_frames(opening, still, every, 0.9) is not None
    assert expression_proposals.blink_frames(opening, still, ~every, 0.9) is None
