import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import pca, region_features


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000))
def test_planted_axes_come_back(seed):
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(12, 3)))[0].T
    scores = np.linalg.qr(rng.normal(size=(40, 3)) - rng.normal())[0] * [9, 4, 1]
    scores -= scores.mean(axis=0)
    frames = rng.normal(size=12) + scores @ axes
    model = pca.fit(frames)
    assert len(model.components) == 3
    _, singular, expected = np.linalg.svd(scores @ axes, full_matrices=False)
    np.testing.assert_allclose(model.variance, singular[:3] ** 2 / 39)
    agreement = np.abs(np.sum(model.components * expected[:3], axis=1))
    np.testing.assert_allclose(agreement, 1)
    rebuilt = model.mean + pca.project(model, frames) @ model.components
    np.testing.assert_allclose(rebuilt, frames, atol=1e-9)


def test_sign_of_an_axis_does_not_depend_on_the_order_of_frames():
    frames = np.random.default_rng(1).normal(size=(30, 5))
    there, back = pca.fit(frames), pca.fit(frames[::-1])
    np.testing.assert_allclose(there.components, back.components, atol=1e-9)
    assert pca.explained(there)[-1] == pytest.approx(1)


@pytest.mark.parametrize("frames", [np.zeros((1, 4)), np.full((5, 4), np.nan)])
def test_too_little_is_refused(frames):
    with pytest.raises(ValueError, match="PCA needs"):
        pca.fit(frames)


def test_distance_of_features_is_the_weighted_distance_of_points():
    rng = np.random.default_rng(2)
    points, weights = rng.normal(size=(2, 6, 2)), rng.random(6)
    a, b = region_features.stack(points, weights)
    squared = np.sum((points[0] - points[1]) ** 2, axis=1)
    assert np.sum((a - b) ** 2) == pytest.approx(np.average(squared, weights=weights))
    np.testing.assert_allclose(region_features.stack(points[0], weights), a)


@pytest.mark.parametrize("weights", [np.ones(5), np.zeros(6), -np.ones(6)])
def test_weights_that_mean_nothing_are_refused(weights):
    with pytest.raises(ValueError, match="weights"):
        region_features.stack(np.zeros((3, 6, 2)), weights)
