import numpy as np
import pytest

from stages.core import head_leak


def test_a_jaw_that_drives_the_head_is_seen_and_an_own_motion_is_not():
    rng = np.random.default_rng(0)
    opening = np.abs(np.cumsum(rng.normal(0, 0.1, 400)))
    own = np.cumsum(rng.normal(0, 0.1, (400, 3)), axis=0)
    assert head_leak.head_leak(own, opening) < 0.2
    leaking = own + opening[:, None] * [0, 0.5, 0]
    assert 0.35 < head_leak.head_leak(leaking, opening) < 0.6
    assert head_leak.head_leak(opening[:, None], opening) == pytest.approx(1)


def test_gaps_are_passed_over_and_too_little_gives_no_figure():
    opening = np.sin(np.arange(40.0))
    motion = opening[:, None].copy()
    motion[5] = np.nan
    assert head_leak.head_leak(motion, opening) == pytest.approx(1)
    assert np.isnan(head_leak.head_leak(motion[:5], opening[:5]))
    assert head_leak.head_leak(np.random.default_rng(0).normal(size=(40, 2)), np.ones(40)) == 0
    with pytest.raises(ValueError, match="got"):
        head_leak.head_leak(motion, opening[1:])
