import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stages.core import graduated_non_convexity, head_motion, rigid_motion, rigidity

STILL, JAW, BROW = 14, 12, 6
FRAMES, NOISE = 240, 0.004
EARS = np.array([0, -0.4, -1.2])  # face units, where the jaw turns


def draw(seed):
    """Return neutral, frames on a moving head, rotations: a third turns with the jaw."""
    rng = np.random.default_rng(seed)
    neutral = np.concatenate(
        [
            rng.uniform([-1.2, -0.6, -0.5], [1.2, 0.3, 0.5], (STILL, 3)),
            rng.uniform([-0.8, -1.9, 0], [0.8, -1.2, 0.6], (JAW, 3)),
            rng.uniform([-0.8, 0.4, 0.3], [0.8, 0.7, 0.6], (BROW, 3)),
        ]
    )
    opening = 0.3 * np.clip(np.sin(np.arange(FRAMES) / 9 + rng.uniform(0, 6)), 0, None)
    face = np.repeat(neutral[None], FRAMES, axis=0)
    hinge = Rotation.from_rotvec(opening[:, None] * [1, 0, 0]).as_matrix()
    jaw = slice(STILL, STILL + JAW)
    face[:, jaw] = (face[:, jaw] - EARS) @ hinge.transpose(0, 2, 1) + EARS
    face[:, STILL + JAW :, 1] += 0.1 * rng.random((FRAMES, 1))
    shift = np.array([2, 0, 1])
    time = np.arange(FRAMES)[:, None] / 60
    turns = Rotation.from_rotvec(0.25 * np.sin(2 * time + [0, 1, 2]))
    points = face @ turns.as_matrix().transpose(0, 2, 1) + np.sin(time + shift)[:, None]
    return rng, neutral, points + rng.normal(0, NOISE, points.shape), turns


def degrees(rotation, turns):
    return np.degrees((Rotation.from_matrix(rotation) * turns.inv()).magnitude()).mean()


def damaged(rng, points, missing, swapped):
    points, honest = points.copy(), points.copy()
    if swapped:
        part = slice(90, 150)
        points[part, [2, 9]] = points[part, [9, 2]]
        honest[part, [2, 9]] = np.nan
    if missing:
        lost = rng.random(points.shape[:2]) < 0.05
        points[lost] = honest[lost] = np.nan
    return points, honest


@pytest.mark.parametrize("missing", [False, True])
@pytest.mark.parametrize("swapped", [False, True])
def test_rigidity_comes_near_an_oracle_under_a_moving_jaw(missing, swapped):
    ratios = []
    for seed in range(4):
        rng, neutral, points, turns = draw(seed)
        points, honest = damaged(rng, points, missing, swapped)
        rigid = (np.arange(len(neutral)) < STILL).astype(float)
        oracle = degrees(rigid_motion.fit(honest, neutral, rigid)[0], turns)
        ratios.append(degrees(rigidity.fit(points, neutral)[0], turns) / oracle)
        published = degrees(head_motion.solve(points, neutral, "published_svd")[0], turns)
        assert published > 3 * oracle
    assert max(ratios) < 1.2


def test_graduated_non_convexity_needs_no_clip():
    _, neutral, points, turns = draw(7)
    wide = [int(frame) for frame in np.argsort(np.ptp(points[..., 1], axis=1))[-5:]]
    alone = [graduated_non_convexity.fit(points[[f]], neutral)[0][0] for f in wide]
    together = graduated_non_convexity.fit(points[wide], neutral)[0]
    np.testing.assert_allclose(alone, together, atol=1e-12)
    published = head_motion.solve(points, neutral, "published_svd")[0]
    better = graduated_non_convexity.fit(points, neutral)[0]
    assert degrees(better, turns) < 0.4 * degrees(published, turns)


def test_the_core_is_the_skull_and_not_the_jaw():
    _, neutral, points, _ = draw(1)
    core = rigidity.core_markers(points, neutral)
    assert core.max() < STILL


def test_swapped_cells_are_told_and_others_are_left():
    rng, neutral, points, _ = draw(2)
    points, honest = damaged(rng, points, False, True)
    core = rigidity.core_markers(points, neutral)
    votes = rigidity.observations(points, neutral, core)
    swapped = np.isnan(honest).any(axis=2)
    assert not votes[swapped].any()
    assert votes[:, :STILL][~swapped[:, :STILL]].mean() > 0.99


def test_a_marker_that_is_wrong_on_the_neutral_counts_for_nothing():
    _, neutral, points, turns = draw(3)
    before = degrees(rigidity.fit(points, neutral)[0], turns)
    wrong = neutral.copy()
    wrong[4] += 0.2
    assert degrees(rigidity.fit(points, wrong)[0], turns) < 1.2 * before


def test_markers_that_are_never_seen_do_no_harm():
    _, neutral, points, turns = draw(4)
    before = degrees(rigidity.fit(points, neutral)[0], turns)
    points[:, [3, STILL]] = np.nan
    assert degrees(rigidity.fit(points, neutral)[0], turns) < 1.2 * before
    points[:, 3:] = np.nan
    with pytest.raises(ValueError, match="fewer than 4 markers"):
        rigidity.fit(points, neutral)


def test_median_passes_over_what_is_not_known():
    values = np.array([[3.0, np.nan, 1.0, 2.0], [np.nan] * 4, [4.0, np.nan, np.nan, 1.0]])
    np.testing.assert_array_equal(rigidity.median(values), [2.0, np.nan, 2.5])
    drawn = np.random.default_rng(0).normal(size=(50, 7))
    np.testing.assert_allclose(rigidity.median(drawn), np.median(drawn, axis=1))
