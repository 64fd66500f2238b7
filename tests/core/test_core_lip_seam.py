import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

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
    (gaps,) = lip_seam.gaps(shapes[:, order], 0)
    assert gaps[0] == gaps[3] == 0.0
    bow = np.sin(RING)[[pair[0] for pair in sorted(expected)]]
    hidden = 0.5 * lip_seam.TOUCH
    wanted = [np.sqrt(np.mean((g * bow - hidden) ** 2)) for g in (0.3, 0.05)]
    np.testing.assert_allclose(gaps[[1, 2]], wanted)


@pytest.mark.parametrize("apart", [0.5, 5.0])
def test_every_mouth_counts_by_itself(apart):
    """One mouth that stays open in a pose shows, whatever the other does."""
    poses = [(0.0, 0.0), (0.3, 0.2), (0.0, 0.1), (0.1, 0.0)]
    both = [[mouth(a), mouth(b, apart)] for a, b in poses]
    gaps = lip_seam.gaps(np.stack([np.concatenate(each) for each in both]), 0)
    alone = [lip_seam.gaps(np.stack(each), 0)[0] for each in zip(*both, strict=True)]
    assert len(gaps) == 2
    np.testing.assert_allclose(
        sorted(gaps.tolist()), sorted(each.tolist() for each in alone), atol=1e-12
    )


@settings(max_examples=25)
@given(st.integers(0, 10**6))
def test_mouths_are_chains_of_near_pairs(seed):
    """The mouths are those of an independent search, whatever the order and number of pairs."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1, 1, (rng.integers(1, 40), 3))
    points = points[rng.integers(0, len(points), 60)]
    apart = np.linalg.norm(points[:, None] - points, axis=2)
    assume(np.abs(apart - lip_seam.ALONG).min() > 2 * lip_seam.TOUCH)
    joined = apart <= lip_seam.ALONG
    for _ in range(6):
        joined = joined @ joined
    found = lip_seam.mouths(points)
    np.testing.assert_array_equal(found[:, None] == found, joined)
    assert set(found.tolist()) == set(range(found.max() + 1))


def test_a_mouth_of_many_pairs_takes_little_room():
    along = np.linspace(0, 1, 50_000)
    points = np.stack([along, 0 * along, 0 * along], axis=1)
    assert not lip_seam.mouths(points).any()


def test_lips_that_never_part_or_touch_are_none():
    assert lip_seam.gaps(np.stack([mouth(0.0), mouth(0.05)]), 0) is None
    assert lip_seam.gaps(np.stack([mouth(0.2), mouth(0.4)]), 0) is None
    assert lip_seam.gaps(np.zeros((2, 0, 3)), 0) is None
