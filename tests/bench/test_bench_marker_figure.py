"""The frames that Deng's figure 6 shows, and the errors that it states."""

from fractions import Fraction

import numpy as np
import pytest

from bench.figures import marker_figure, rig_methods
from data_example.generator import marker_cues
from stages.files import driving_points

FRAMES, RATE = 1320, 120


@pytest.fixture
def played():
    rng = np.random.default_rng(0)
    frame = np.arange(FRAMES)
    points = np.cumsum(rng.normal(size=(FRAMES, 5, 3)), axis=0)
    points[100:110, 2] = np.nan
    names = [f"m{index}" for index in range(5)]
    given = (Fraction(RATE), names, points, points[0], np.ones(FRAMES))
    driving = driving_points.DrivingPoints(frame, frame / RATE, *given)
    deltas = np.zeros((2, 4, 3))
    deltas[0, 0], deltas[1, 1] = (3, 0, 4), (0, 1, 0)
    true = rng.uniform(size=(FRAMES, 2))
    return rig_methods.Played(
        driving, None, deltas, frame[::20], {"true": true, "off": true + np.array([0.1, 0.2])}
    )


def test_frames_are_pictures_of_every_emotion_and_untuned(played):
    frames, moods = marker_figure.chosen_frames(played, 4)
    assert moods == ["neutral", "happiness", "happiness", "anger", "anger", "sadness"]
    assert all(frame % 4 == 0 for frame in frames)
    assert np.abs(np.subtract.outer(frames, played.tuned)).min() >= marker_figure.APART
    starts = [marker_cues.SENTENCES[mood] for mood in moods]
    assert all(frame / RATE >= start for frame, start in zip(frames, starts, strict=True))
    assert sorted(set(frames)) == frames


def test_errors_are_mean_distances_of_the_vertices_that_move(played):
    np.testing.assert_allclose(rig_methods.errors_mm(played, "off"), 10 * (0.5 + 0.2) / 2)
    assert not rig_methods.errors_mm(played, "true").any()
