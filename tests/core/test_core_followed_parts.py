import numpy as np

from stages.core import followed_parts, follower

RATE = 60.0


def speaking():
    """Return a mask's emotion that switches, and speech that closes the lips twice."""
    time = np.arange(240) / RATE
    closing = np.zeros(240)
    for middle in (1.0, 2.5):
        closing = np.maximum(closing, 1 - np.clip((np.abs(time - middle) - 0.05) / 0.08, 0, 1))
    joy = np.where(time < 2, 0.7, 0.2) * (1 - closing)
    rage = np.where(time < 2, 0.0, 0.6) * (1 - closing)
    other = np.where(time < 2, 0.1, 0.9)
    return closing, np.column_stack([joy, closing, rage, other])


FOLLOWED, WHOLE = np.array([True, False, True, True]), np.array([0, 0, 0, 1])


def test_lips_close_when_they_did():
    closing, values = speaking()
    made = followed_parts.follow(values, FOLLOWED, WHOLE, RATE, 0.15, 0.5)
    np.testing.assert_array_equal(made[:, 1], values[:, 1])
    assert np.abs(made[closing == 1][:, [0, 2]]).max() == 0.0
    assert (made[:, :3].sum(axis=1) <= 1.1).all()
    plain = follower.follow(values, RATE, 0.15, 0.5)
    assert plain[closing == 1][:, [0, 2]].max() > 0.3


def test_where_nothing_is_taken_the_follower_is_plain():
    _, values = speaking()
    values[:, 1] = 0.0
    made = followed_parts.follow(values, FOLLOWED, WHOLE, RATE, 0.15, 0.5)
    expected = follower.follow(values, RATE, 0.15, 0.5)
    np.testing.assert_allclose(made[:, [0, 2, 3]], expected[:, [0, 2, 3]], atol=1e-12)
    assert made[:, 3].max() > 0.95 > values[:, 3].max()


def test_gaps_stay_and_a_mask_that_speech_fills_stays():
    _, values = speaking()
    values[30:40] = np.nan
    made = followed_parts.follow(values, FOLLOWED, WHOLE, RATE, 0.15, 0.5)
    np.testing.assert_array_equal(np.isnan(made), np.isnan(values))
    values[:, 1] = 1.0
    made = followed_parts.follow(values, FOLLOWED, WHOLE, RATE, 0.15, 0.5)
    np.testing.assert_array_equal(made[:, :3], values[:, :3])
    np.testing.assert_array_equal(
        followed_parts.follow(values, FOLLOWED, WHOLE, RATE, 0, 1), values
    )
