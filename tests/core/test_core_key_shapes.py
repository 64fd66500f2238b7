import numpy as np
import pytest

from stages.core import (
    clustering,
    key_shape_candidates,
    key_shape_count,
    key_shape_errors,
    key_shape_selection,
    key_weights,
    pca,
)

METHODS = tuple(key_shape_selection.SELECTORS)
COUNTED = tuple(name for name in METHODS if name != key_shape_selection.FIXED_BY_DATA)
# planted extremes stand here; all else is a mixture of them and the neutral
CORNERS = (3, 20, 41, 60)


def candidates_of(frames, **changes):
    given = key_shape_candidates.Candidates(
        frames, np.zeros(frames.shape[1]), pca.fit(frames), np.ones(len(frames), bool)
    )
    return given._replace(**changes)


@pytest.fixture(name="planted")
def _planted():
    rng = np.random.default_rng(8)
    extremes = np.linalg.qr(rng.normal(size=(10, 4)))[0].T * [[4], [3.5], [3], [2.5]]
    mix = rng.dirichlet(np.ones(5), 80)[:, :4] * 0.9
    mix[list(CORNERS)] = np.eye(4)
    return candidates_of(mix @ extremes)


def frames_of(choices):
    return [choice.frame for choice in choices]


@pytest.mark.parametrize(
    "method", ["successive_projection", "farthest_residual", "shared_residual", "expected_error"]
)
def test_planted_extremes_are_found(planted, method):
    assert set(frames_of(key_shape_selection.choose(planted, 4, method))) == set(CORNERS)


def test_swaps_find_planted_extremes_or_leave_nothing_unexplained(planted):
    chosen = frames_of(key_shape_selection.choose(planted, 4, "swap_refinement"))
    assert set(chosen) == set(CORNERS)


@pytest.mark.parametrize("method", COUNTED)
@pytest.mark.parametrize("count", [4, 7])
def test_locked_frames_come_first_and_banned_or_doubtful_ones_never(planted, method, count):
    usual = frames_of(key_shape_selection.choose(planted, count, method))
    eligible = np.ones(80, bool)
    banned = next(frame for frame in usual if frame not in (11, 5))
    eligible[[banned, 11]] = False
    changed = planted._replace(eligible=eligible, locked=(11, 5))
    choices = key_shape_selection.choose(changed, count, method)
    chosen = frames_of(choices)
    assert chosen[:2] == [11, 5]
    assert choices[0].reason == key_shape_candidates.LOCKED
    assert banned not in chosen
    assert len(set(chosen)) == count


@pytest.mark.parametrize("method", METHODS)
def test_choice_is_the_same_every_time_and_its_reasons_are_words(planted, method):
    first = key_shape_selection.choose(planted, 6, method)
    assert first == key_shape_selection.choose(planted, 6, method)
    assert all(isinstance(choice.frame, int) and choice.reason for choice in first)


@pytest.mark.parametrize("method", METHODS)
def test_badly_tracked_frames_neither_count_nor_pull(planted, method):
    frames = planted.frames.copy()
    eligible = np.ones(80, bool)
    frames[70], frames[71] = 1000.0, np.nan
    eligible[70:72] = False
    kept = np.arange(80)[eligible]
    here = frames_of(
        key_shape_selection.choose(planted._replace(frames=frames, eligible=eligible), 5, method)
    )
    there = frames_of(
        key_shape_selection.choose(
            planted._replace(frames=frames[kept], eligible=np.ones(78, bool)), 5, method
        )
    )
    assert here == kept[there].tolist()


@pytest.mark.parametrize("method", key_shape_selection.NESTED)
def test_fewer_shapes_are_the_first_of_more(planted, method):
    few, many = (key_shape_selection.choose(planted, count, method) for count in (3, 8))
    assert many[:3] == few


@pytest.mark.parametrize("count", [0, 81])
def test_counts_that_cannot_be_filled_are_refused(planted, count):
    for method in COUNTED:
        with pytest.raises(ValueError, match="cannot be chosen"):
            key_shape_selection.choose(planted, count, method)
    with pytest.raises(ValueError, match="magic"):
        key_shape_selection.choose(planted, 3, "magic")


def cross():
    # frame 0 is the extreme of both axes, 1 the next of the second; 4 the largest of axis 3
    frames = np.zeros((12, 3))
    frames[0] = [10, 3, 0]
    frames[1] = [0, 2.5, 0]
    frames[2] = [-9, 0, 0]
    frames[3] = [0, -2.8, 0]
    frames[4] = [0, 0, 0.8]
    frames[5] = [0, 0, -1.0]
    axes = pca.Pca(np.zeros(3), np.eye(3), np.array([9.0, 4.0, 1.0]))
    return candidates_of(frames)._replace(model=axes)


def test_maximum_spread_takes_the_next_extreme_where_one_frame_is_two():
    choices = key_shape_selection.choose(cross(), 4, "maximum_spread")
    assert frames_of(choices) == [0, 2, 1, 3]
    assert choices[2].reason == "largest along axis 2"


def test_maximum_spread_with_one_left_takes_the_farther_end():
    assert frames_of(key_shape_selection.choose(cross(), 5, "maximum_spread"))[-1] == 5


@pytest.mark.parametrize("locked", [(0,), (2, 3), (1, 5, 0)])
def test_locking_some_of_maximum_spreads_own_choice_keeps_the_rest(locked):
    usual = set(frames_of(key_shape_selection.choose(cross(), 6, "maximum_spread")))
    choices = key_shape_selection.choose(cross()._replace(locked=locked), 6, "maximum_spread")
    assert set(frames_of(choices)) == usual


def test_clusters_that_stand_apart_are_found_and_their_centres_are_means():
    rng = np.random.default_rng(3)
    places = np.array([[0, 0, 0], [9, 0, 0], [0, 8, 0], [7, 7, 0.0]])
    frames = np.repeat(places, 15, axis=0) + 0.1 * rng.normal(size=(60, 3))
    given = candidates_of(frames, seed=5)
    chosen = frames_of(clustering.choose(given, 4, 2))
    assert sorted(frame // 15 for frame in chosen) == [0, 1, 2, 3]
    means = clustering.centres(given, 4, 2)
    expected = frames.reshape(4, 15, 3).mean(axis=1)
    order = [int(np.argmin(np.linalg.norm(means - mean, axis=1))) for mean in expected]
    np.testing.assert_allclose(means[order], expected)


def test_hull_is_the_one_that_scipy_finds():
    spatial = pytest.importorskip("scipy.spatial")
    frames = np.random.default_rng(4).normal(size=(50, 2)) * [3, 1]
    given = candidates_of(frames)
    chosen = frames_of(key_shape_selection.choose(given, 1, "convex_hull"))
    hull = spatial.ConvexHull(pca.project(given.model, frames))
    assert set(chosen) == set(hull.vertices.tolist())


def test_blocks_are_runs_of_time_within_each_shot():
    shots = np.repeat(["a", "b"], [40, 24])
    fold = key_shape_errors.blocks(shots, np.r_[0:40, 0:24], 4)
    np.testing.assert_array_equal(fold[:40], np.repeat([0, 1, 2, 3, 0, 1, 2, 3], 5))
    np.testing.assert_array_equal(fold[40:], np.repeat([0, 1, 2, 3, 0, 1, 2, 3], 3))


def test_errors_of_a_curve_are_those_of_choosing_and_solving_by_hand(planted):
    fold = np.arange(80) // 40
    got = key_shape_errors.curve(planted, fold, "maximum_spread", [3, 99], _offset)
    squares = {"training": [], "held_out": []}
    for number in (0, 1):
        inside = planted.frames[fold == number]
        training = candidates_of(planted.frames[fold != number])
        keys = frames_of(key_shape_selection.choose(training, 3, "maximum_spread"))
        for split, frames in (("training", training.frames), ("held_out", inside)):
            solved = _offset(frames, training.frames[keys], planted.neutral)
            squares[split].append(solved.residual**2)
    expected = [
        (3, split, np.sqrt(np.mean(np.concatenate(parts)))) for split, parts in squares.items()
    ]
    assert [row[:2] for row in got] == [row[:2] for row in expected]
    np.testing.assert_allclose([row[2] for row in got], [row[2] for row in expected])


def _offset(frames, shapes, neutral):
    return key_weights.solve(frames, shapes, neutral, "nonnegative_offset")


@pytest.mark.parametrize("method", key_shape_errors.METHODS)
def test_every_method_has_a_curve(planted, method):
    fold = key_shape_errors.blocks(np.full(80, "a"), np.arange(80), 2)
    rows = key_shape_errors.curve(planted, fold, method, [2, 5], _offset)
    assert {row[1] for row in rows} == {"training", "held_out"}
    if method != key_shape_selection.FIXED_BY_DATA:
        assert [row[0] for row in rows] == [2, 2, 5, 5]


def test_budget_takes_the_fewest_that_suffice_or_says_that_none_does():
    counts, errors = [2, 4, 8, 16], [0.9, 0.5, 0.2, 0.25]
    assert key_shape_count.within_budget(counts, errors, 0.5)[0] == 4
    count, why = key_shape_count.within_budget(counts, errors, 0.1)
    assert count == 8
    assert "no count" in why


def test_knee_is_where_the_curve_bends_whatever_its_units():
    counts, errors = [2, 4, 6, 8, 10, 12], np.array([1, 0.6, 0.2, 0.18, 0.15, 0.14])
    assert key_shape_count.at_knee(counts, errors)[0] == 6
    assert key_shape_count.at_knee(counts, 50 * errors)[0] == 6
    assert key_shape_count.at_knee([7], [0.1])[0] == 7


def test_counts_and_errors_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match="do not fit"):
        key_shape_count.at_knee([1, 2], [0.1])
