import numpy as np
import pytest

from stages.core import lip_seam

RING = np.linspace(0.1, np.pi - 0.1, 12)


def mouth(opened, height=0.0):
    """A lower lip, an upper one and skin about them, the lips apart by a bow."""
    lower = np.stack([np.cos(RING), height - 0.5 * opened * np.sin(RING), 0 * RING], axis=1)
    upper = np.stack([np.cos(RING), height + 0.5 * opened * np.sin(RING), 0 * RING], axis=1)
    grid = np.stack(np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 8)), -1).reshape(-1, 2)
    skin = np.column_stack([grid, np.full(len(grid), -0.3)])
    return np.concatenate([lower, upper, skin])


@pytest.mark.parametrize("shuffled", [False, True])
def test_lips_meet_where_they_touch_and_part(shuffled):
    shapes = np.stack([mouth(gap) for gap in (0.0, 0.3, 0.05, 0.0)])
    order = np.arange(shapes.shape[1])
    if shuffled:
        order = np.random.default_rng(0).permutation(len(order))
    found = lip_seam.pairs(shapes[:, order], 0)
    expected = {(i, i + len(RING)) for i in np.flatnonzero(0.3 * np.sin(RING) > lip_seam.PART)}
    assert {tuple(sorted(pair)) for pair in order[found].tolist()} == expected
    gaps = lip_seam.gaps(shapes[:, order], 0)
    assert gaps[0] == gaps[3] == 0.0
    bow = np.sin(RING)[[pair[0] for pair in sorted(expected)]]
    hidden = 0.5 * lip_seam.TOUCH
    np.testing.assert_allclose(gaps[[1, 2]], [(g * bow - hidden).mean() for g in (0.3, 0.05)])


def test_every_mouth_counts():
    """One mouth that stays open in a pose shows, whatever the other does."""
    poses = [(0.0, 0.0), (0.3, 0.3), (0.0, 0.1), (0.0, 0.0)]
    shapes = np.stack([np.concatenate([mouth(a), mouth(b, 5.0)]) for a, b in poses])
    gaps = lip_seam.gaps(shapes, 0)
    assert gaps[1] > gaps[2] > 0.02 and gaps[0] == gaps[3] == 0.0


def test_lips_that_never_part_or_touch_are_none():
    assert lip_seam.gaps(np.stack([mouth(0.0), mouth(0.05)]), 0) is None
    assert lip_seam.gaps(np.stack([mouth(0.2), mouth(0.4)]), 0) is None
    assert lip_seam.gaps(np.zeros((2, 0, 3)), 0) is None
