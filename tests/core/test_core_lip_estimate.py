import numpy as np

from stages.core import lip_estimate


def planted(rng, count=400):
    """Offsets of which ten coordinates tell the gap, and the gap as noisy points show it."""
    offsets = rng.normal(size=(count, 14))
    gap = 0.2 + offsets[:, :10] @ rng.normal(size=10) / 20
    return offsets, gap, gap + 0.02 * rng.normal(size=count)


def test_noise_of_the_points_averages_out():
    rng = np.random.default_rng(0)
    offsets, gap, seen = planted(rng)
    chosen = np.arange(14) < 12
    seen[7], offsets[9, 3] = np.nan, np.nan
    found = lip_estimate.fit(offsets[:300], seen[:300], chosen)
    assert not found.weights[12:].any()
    told = lip_estimate.gap(found, offsets[300:])
    wrong = np.sqrt(np.mean((told - gap[300:]) ** 2))
    assert wrong < 0.35 * np.sqrt(np.nanmean((seen - gap)[300:] ** 2))


def test_a_missing_coordinate_tells_nothing():
    rng = np.random.default_rng(1)
    offsets, _, seen = planted(rng)
    chosen = np.arange(14) < 12
    found = lip_estimate.fit(offsets, seen, chosen)
    offsets[3, 2] = offsets[4, 13] = np.nan
    told = lip_estimate.gap(found, offsets)
    assert np.isnan(told[3]) and np.isfinite(told[4])


def test_too_few_frames_tell_nothing():
    rng = np.random.default_rng(2)
    offsets, _, seen = planted(rng, 12)
    assert lip_estimate.fit(offsets, seen, np.arange(14) < 12) is None
