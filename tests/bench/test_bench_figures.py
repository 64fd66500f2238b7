"""The numbers behind the figures: tracing, reconstruction, choice of frames, errors."""

import numpy as np
import pytest

from bench.figures import (
    key_shape_figure,
    lip_trial,
    own_key_shapes,
    portraits,
    region_frames,
    tracing,
)
from stages.core import key_shape_errors, key_weights
from stages.files import region_settings

SETTINGS = region_settings.Settings(12, None, "maximum_spread", "tolerant", 0.15, None)
CONTOURS = np.repeat(["lips_outer", "lips_inner"], [20, 16])


@pytest.fixture
def generator():
    """Return a seeded generator."""
    return np.random.default_rng(3)


def lips(generator, frames, corners):
    """Return frames inside the convex hull of corner shapes, the corners among them."""
    shapes = generator.normal(size=(corners, len(CONTOURS), 2))
    weights = generator.dirichlet(np.ones(corners), frames)
    weights[:corners] = np.eye(corners)
    points = np.tensordot(weights, shapes, axes=1)
    names = [f"{name}_{row:02d}" for row, name in enumerate(CONTOURS)]
    neutral = shapes.mean(axis=0)
    return region_frames.RegionFrames(
        points, neutral, np.ones(len(CONTOURS)), names, np.arange(frames)
    )


def test_tracing_has_its_size_and_its_seed():
    drawn = tracing.error(4000, CONTOURS, 0.015, 7)
    assert np.sqrt((drawn**2).sum(axis=2).mean()) == pytest.approx(0.015, rel=0.02)
    assert abs(drawn.mean()) < 5e-4
    np.testing.assert_array_equal(drawn, tracing.error(4000, CONTOURS, 0.015, 7))
    assert not np.allclose(drawn, tracing.error(4000, CONTOURS, 0.015, 8))


@pytest.mark.parametrize("contour", ["lips_outer", "lips_inner"])
def test_tracing_is_smooth_along_each_contour(contour):
    drawn = tracing.error(50, CONTOURS, 0.015, 1)[:, contour == CONTOURS]
    spectrum = np.abs(np.fft.rfft(drawn, axis=1))
    assert spectrum[:, tracing.WAVES + 1 :].max() < 1e-12
    assert (spectrum[:, 1].mean() > spectrum[:, 2 : tracing.WAVES + 1].mean(axis=(0, 2))).all()


@pytest.mark.parametrize("name", list(lip_trial.solves(SETTINGS)))
def test_a_perfect_tracing_changes_nothing(generator, name):
    take = lips(generator, 30, 5)
    still = [np.zeros((6, *take.neutral.shape))]
    solved = lip_trial.reconstruct(
        take.points, take.points[:5], take.neutral, still, lip_trial.solves(SETTINGS)[name]
    )
    np.testing.assert_allclose(solved.target, solved.source, atol=1e-12)
    assert solved.target_rms == pytest.approx(lip_trial.rms(solved.source_error))
    if name != lip_trial.DEFAULT:
        assert solved.source_error.max() < 1e-9


def test_the_neutral_is_traced_too(generator):
    take = lips(generator, 30, 5)
    shift = [np.full((6, *take.neutral.shape), 0.25)]
    moved = lip_trial.reconstruct(
        take.points,
        take.points[:5],
        take.neutral,
        shift,
        lip_trial.solves(SETTINGS)[lip_trial.DEFAULT],
    )
    np.testing.assert_allclose(moved.target - moved.source, 0.25, atol=1e-12)


def test_nearly_dependent_shapes_spoil_least_squares_only(generator):
    take = lips(generator, 60, 6)
    double = take.points[:6] + generator.normal(scale=0.002, size=take.points[:6].shape)
    shapes = np.concatenate([take.points[:6], double])
    noisy = take.points + generator.normal(scale=0.02, size=take.points.shape)
    drawn = [tracing.error(13, CONTOURS, 0.05, seed) for seed in range(5)]
    found = {
        name: lip_trial.reconstruct(noisy, shapes, take.neutral, drawn, how)
        for name, how in lip_trial.solves(SETTINGS).items()
    }
    plain = found[lip_trial.PLAIN]
    for name in (lip_trial.NONNEGATIVE, lip_trial.DEFAULT):
        assert lip_trial.rms(plain.source_error) < lip_trial.rms(found[name].source_error)
        assert plain.target_rms > 2 * found[name].target_rms


def test_sample_ends_with_the_worst_frame(generator):
    take = lips(generator, 60, 22)
    trial = lip_trial.run(take, take, SETTINGS)
    for name, solved in trial.solved.items():
        *spread, worst = lip_trial.sample(trial, name, 5)
        assert solved.target_error[worst] == solved.target_error.max()
        assert len(spread) == 5
        assert np.ptp(np.diff(spread)) <= 1


def test_figure_6_reaches_zero_at_the_corners(generator):
    take = lips(generator, 160, 6)
    for start in range(0, 160, 20):
        take.points[start : start + 6] = take.points[:6]
    rows = key_shape_figure.nonnegative_errors(take, 0.1)
    error = {(row["method"], row["split"], row["count"]): row["rms"] for row in rows}
    for split in ("training", "held_out"):
        assert error["successive_projection", split, 6] < 1e-9
        assert error["successive_projection", split, 4] > 0.01
        assert error["maximum_spread", split, 24] < error["maximum_spread", split, 4]


def test_figure_6_has_a_line_for_every_selector():
    assert set(key_shape_figure.STYLES) == set(key_shape_errors.METHODS)


def test_farthest_frames_differ_and_stand_apart(generator):
    features = 0.01 * generator.normal(size=(200, 4))
    corners = {20: 3.0, 21: 2.9, 90: 2.0, 150: -2.5}
    for row, size in corners.items():
        features[row, row % 4] = size
    picked = portraits.farthest(features, np.arange(200), 3)
    assert picked == [20, 150, 90]
    many = np.sort(portraits.farthest(features, np.arange(200), 6))
    assert np.diff(many).min() >= 200 / 18 - 1


def test_own_key_shapes_rebuild_their_sequence(generator):
    own = lips(generator, 40, 5)
    origin = [("turn", row) for row in range(5)]
    settings = region_settings.Settings(5, None, "successive_projection", "simplex", 0.0, None)
    exact = {"mouth": own_key_shapes.KeySet(origin, own.points[:5])}
    poor = {"mouth": own_key_shapes.KeySet(origin, own.points[10:15])}
    sequence = own_key_shapes.Sequence(
        own.frame, {"mouth": own}, {"mouth": settings}, {"own": exact, "poor": poor}
    )
    weights, error = own_key_shapes.solve(sequence, "own")
    assert error["mouth"] < 1e-6
    rebuilt = lip_trial.play(weights["mouth"], own.points[:5], own.neutral)
    np.testing.assert_allclose(rebuilt, own.points, atol=1e-6)
    points = lip_trial.play(
        own_key_shapes.solve(sequence, "poor")[0]["mouth"], own.points[10:15], own.neutral
    )
    by_hand = lip_trial.rms(lip_trial.point_error(points, own.points))
    assert own_key_shapes.solve(sequence, "poor")[1]["mouth"] == pytest.approx(by_hand)


def test_vertex_error_counts_only_what_moves():
    neutral = np.zeros((3, 3))
    truth = np.zeros((2, 3, 3))
    truth[1, 0] = [3.0, 0.0, 0.0]
    truth[1, 1] = [0.0, 0.019, 0.0]
    moved = truth.copy()
    moved[0, 0] = [0.0, 0.0, 1.0]
    moved[:, 1:] += 100.0
    np.testing.assert_allclose(
        own_key_shapes.vertex_error(moved, truth, neutral, 2.0), [0.5, 0.0], atol=1e-12
    )


def test_equation_4_has_no_neutral(generator):
    take = lips(generator, 20, 4)
    frames, neutral = region_frames.features(take)
    shapes = frames[:4]
    first = key_shape_figure._solve(frames, shapes, neutral)
    other = key_shape_figure._solve(frames, shapes, neutral + 5.0)
    np.testing.assert_array_equal(first.residual, other.residual)
    assert first.residual.max() < 1e-9
    plain = key_weights.solve(frames, shapes, 0 * neutral, "nonnegative_absolute")
    np.testing.assert_array_equal(first.weights, plain.weights)
