from fractions import Fraction

import numpy as np
import pytest

from stages.files import lip_gap, series

NAMES = ["a", "b", "c", "d"]


@pytest.fixture
def points(tmp_path):
    """Four points of a film on five frames, one of them not observed on the last."""
    places = np.random.default_rng(0).normal(size=(5, 4, 2))
    places[4, 3] = np.nan
    path, frame = tmp_path / "expression.parquet", np.arange(5)
    meta = {"points": NAMES}
    rate = Fraction(30)
    series.write(path, "expression", frame, frame / 30, series.unstack(places, NAMES), rate, meta)
    return path, places


def test_several_pairs_tell_their_mean(points):
    path, places = points
    one, other = (np.linalg.norm(places[:, i] - places[:, i + 1], axis=1) for i in (0, 2))
    frame = np.arange(5)
    np.testing.assert_allclose(lip_gap.read(path, "a, b", frame), one, rtol=1e-5)
    mean = lip_gap.read(path, "a,b; c,d", frame)
    np.testing.assert_allclose(mean, (one + other) / 2, rtol=1e-5)
    assert np.isnan(mean[4]) and np.isfinite(mean[:4]).all()
    assert lip_gap.read(path, "", frame) is None
