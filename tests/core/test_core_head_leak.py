import numpy as np
import pytest

from stages.core import head_leak


def test_a_jaw_that_drives_the_head_is_seen_and_an_own_motion_is_not():
    rng = np.random.default_rng(0)
    opening = np.abs(rng.normal(0, 1, 900))
    own = np.cumsum(rng.normal(0, 0.5, (900, 3)), axis=0)
    assert head_leak.head_leak(own, opening, 30) < 0.15
    leaking = own + opening[:, None] * [0, 2.0, 0]
    assert 0.4 < head_leak.head_leak(leaking, opening, 30) < 0.95
    assert head_leak.head_leak(opening[:, None], opening, 30) == pytest.approx(1)


def test_a_slow_nod_in_step_with_the_voice_is_no_leak():
    time = np.arange(900) / 30
    nod = np.sin(0.8 * time)
    opening = nod + np.sin(25 * time)
    assert head_leak.head_leak(nod[:, None], opening, 30) < 0.1


def test_gaps_are_passed_over_and_too_little_gives_no_figure():
    opening = np.sin(np.arange(40.0))
    motion = opening[:, None].copy()
    motion[5] = np.nan
    assert head_leak.head_leak(motion, opening, 30) == pytest.approx(1)
    assert np.isnan(head_leak.head_leak(motion[:5], opening[:5], 30))
    assert head_leak.head_leak(np.random.default_rng(0).normal(size=(40, 2)), np.ones(40), 30) == 0
    with pytest.raises(ValueError, match="got"):
        head_leak.head_leak(motion, opening[1:], 30)


def test_the_strongest_motion_is_the_planted_one():
    rng = np.random.default_rng(1)
    jaw, axis = rng.normal(size=50), rng.normal(size=12)
    points = 3 * jaw[:, None] * axis + 0.01 * rng.normal(size=(50, 12))
    points[7, 3:] = np.nan
    found = head_leak.strongest_motion(points)
    assert np.isnan(found[7])
    assert abs(np.corrcoef(np.delete(found, 7), np.delete(jaw, 7))[0, 1]) > 0.999


def test_single_missing_markers_leave_no_frame_without_a_motion():
    rng = np.random.default_rng(2)
    jaw, axis = rng.normal(size=300), rng.normal(size=90)
    points = 3 * jaw[:, None] * axis + 0.01 * rng.normal(size=(300, 90))
    points[rng.random(points.shape) < 0.05] = np.nan
    found = head_leak.strongest_motion(points)
    assert abs(np.corrcoef(found, jaw)[0, 1]) > 0.99
