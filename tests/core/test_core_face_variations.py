import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import confidence, descent, face_frame, face_variations, point_groups, similarity

GROUPS = (np.arange(4), np.arange(4, 9))


def shape_of(seed):
    return np.random.default_rng(seed).uniform(20, 60, (9, 2))


def test_a_groups_spread_is_measured_on_both_axes():
    rng = np.random.default_rng(0)
    shapes = np.repeat(shape_of(1)[None], 4000, axis=0)
    shapes[:, GROUPS[0]] += rng.normal(0, (2.0, 0.5), (4000, 1, 2))
    middle = shapes[:, GROUPS[1]].mean(axis=1, keepdims=True)
    factors = np.exp(rng.normal(0, (0.1, 0.02), (4000, 1, 2)))
    shapes[:, GROUPS[1]] = middle + factors * (shapes[:, GROUPS[1]] - middle)
    spread = face_variations.group_spread(shapes, GROUPS, (4.0, 0.3))
    assert spread[0, 0] == pytest.approx([2.0, 0.5], rel=0.05)
    assert spread[1, 1] == pytest.approx([0.1, 0.02], rel=0.05)
    assert np.abs([spread[0, 1], spread[1, 0]]).max() < 1e-9


def test_a_closing_lid_does_not_stretch_without_bound():
    shapes = np.stack([shape_of(2), shape_of(2)])
    shapes[1, GROUPS[0], 1] = 30.0
    spread = face_variations.group_spread(shapes, GROUPS, (4.0, 0.3))
    assert spread[0, 1, 1] == 0.3
    assert np.isfinite(spread).all()


@given(st.integers(0, 2**31))
def test_without_spread_nothing_is_stretched(seed):
    shape, rng = shape_of(seed), np.random.default_rng(seed)
    same = face_variations.stretched(shape, GROUPS, np.zeros((2, 2, 2)), rng)
    assert same == pytest.approx(shape)


@given(st.integers(0, 2**31))
def test_a_group_stretches_along_the_axes_only(seed):
    shape, rng = shape_of(seed), np.random.default_rng(seed)
    found = face_variations.stretched(shape, GROUPS, np.full((2, 2, 2), 0.2), rng)
    for group in GROUPS:
        for axis in range(2):
            before, after = shape[group, axis], found[group, axis]
            slope, shift = np.polyfit(before, after, 1)
            assert slope > 0
            assert slope * before + shift == pytest.approx(after, abs=1e-6)


def test_light_changes_every_pixel_by_one_gain():
    image = np.full((20, 20, 3), (100, 120, 80), np.uint8)
    lit = face_variations.relit(image, 0.2, 0.1, 0.0, np.random.default_rng(3))
    assert len(np.unique(lit.reshape(-1, 3), axis=0)) == 1
    assert not np.array_equal(lit, image)


def test_inner_contours_join_the_outer_ones():
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    shape = np.concatenate([10 * square, [[5.0, 5]], 4 * square + 3, 2 * square + [20, 3]])
    owners = ["lips_outer"] * 4 + ["dot"] + ["lips_inner"] * 4 + ["brow"] * 4
    groups = point_groups.nested(owners, shape)
    assert [group.tolist() for group in groups] == [list(range(9)), list(range(9, 13))]
    with pytest.raises(ValueError, match="12 owners for 13 points"):
        point_groups.nested(owners[1:], shape)


def test_the_cascade_brings_left_out_starts_nearer():
    rng = np.random.default_rng(4)
    base = shape_of(5)
    frame = face_frame.around(base, 15.0)
    texture = rng.integers(0, 255, (10, 12, 3)).astype(np.uint8)
    image = np.kron(texture, np.ones((10, 10, 1), np.uint8))
    truth = np.repeat((frame.points + 6)[None], 40, axis=0)
    starts = truth + rng.normal(0, 2, (40, 1, 2))
    images = np.repeat(image[None], 40, axis=0)
    _, reached = descent.train(
        images, np.arange(40), truth, starts, frame, GROUPS, (1.0, 1.0, 1.0, 1.0)
    )
    before, after = (np.linalg.norm(x - truth, axis=2).mean() for x in (starts, reached))
    assert after < 0.3 * before
    with pytest.raises(ValueError, match="do not correspond"):
        descent.train(images[:9], np.arange(40), truth, starts, frame, GROUPS, (1.0,) * 4)


def test_distance_from_a_subspace_ignores_what_lies_in_it():
    rng = np.random.default_rng(6)
    inside = rng.normal(size=(3, 50))
    seen = (rng.normal(size=(30, 2, 3)) @ inside + 5).astype(np.float32)
    mean, basis = confidence.span(seen, components=3)
    within = (rng.normal(size=(2, 3)) @ inside + 5).astype(np.float32)
    off = rng.normal(size=(2, 50))
    off -= (off @ np.linalg.pinv(inside)) @ inside
    near = confidence.log_distance(mean, basis, within)
    far = confidence.log_distance(mean, basis, (within + off).astype(np.float32))
    assert near.max() < -3
    assert far == pytest.approx(np.log(np.linalg.norm(off, axis=1)), abs=0.05)


def test_confidence_separates_right_from_wrong_and_grades_between():
    rng = np.random.default_rng(7)
    mean, basis = np.zeros((9, 5), np.float32), np.zeros((9, 5, 1), np.float32)
    right, wrong = rng.normal(0, 0.1, (60, 9)), rng.normal(0, 0.1, (60, 9))
    is_wrong = np.zeros((60, 9), bool)
    is_wrong[:30, GROUPS[0]] = is_wrong[30:, GROUPS[1]] = True
    wrong[is_wrong] += 1.0
    model = confidence.train(mean, basis, right, wrong, is_wrong, GROUPS)
    described = np.zeros((9, 5), np.float32)
    described[:, 0] = 1.0
    described[GROUPS[1], 0] = np.e
    points, face = confidence.judge(model, described, GROUPS)
    assert points[GROUPS[0]].min() > 0.8
    assert points[GROUPS[1]].max() < 0.2
    assert face == pytest.approx(np.median(points))


def test_a_frame_lies_round_the_mean_shape():
    mean = similarity.mean_shape(np.stack([shape_of(8), shape_of(8) + 3]), 30.0)
    frame = face_frame.around(mean, 10.0)
    assert frame.points.min(axis=0) == pytest.approx([10, 10])
    assert (frame.points.max(axis=0) + 10 <= frame.size).all()
    wide = face_frame.widened(frame, 7)
    assert wide.size == (frame.size[0] + 14, frame.size[1] + 14)
    placed = 2 * frame.points + 5
    assert similarity.apply(frame.pose(placed), frame.points) == pytest.approx(placed)
