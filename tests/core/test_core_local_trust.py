import numpy as np

from stages.core import local_trust

RATE = 60.0


def test_a_sudden_move_is_kept_and_jitter_is_not():
    rng = np.random.default_rng(0)
    keen = 0.01 * rng.standard_normal((600, 1))
    keen[300:308] += 0.5
    calm, none = np.zeros((600, 1)), np.zeros((600, 1))
    made = local_trust.blended(keen, calm, keen, none, RATE)
    np.testing.assert_allclose(made[301:307], keen[301:307], atol=0.02)
    still = np.r_[0:280, 330:600]
    assert np.std(made[still]) < 0.3 * np.std(keen[still])


def test_events_are_the_keen_curve():
    rng = np.random.default_rng(1)
    keen, calm = rng.standard_normal((50, 3)), rng.standard_normal((50, 3))
    made = local_trust.blended(keen, calm, keen, np.ones((50, 3)), RATE)
    np.testing.assert_allclose(made, keen, atol=1e-12)
    same = local_trust.blended(keen, calm, calm, np.zeros((50, 3)), RATE)
    np.testing.assert_array_equal(same, calm)


def test_a_calm_curve_that_is_nearer_stays():
    measured = np.random.default_rng(2).standard_normal((80, 2))
    calm, keen = 0.9 * measured, 0.5 * measured
    made = local_trust.blended(measured, calm, keen, np.ones((80, 2)), RATE)
    np.testing.assert_array_equal(made, calm)
