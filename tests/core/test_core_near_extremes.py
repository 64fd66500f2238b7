import numpy as np
import pytest

from stages.core import near_extremes


def test_near_extremes_of_one_layer_are_found_nearest_first():
    rng = np.random.default_rng(0)
    basis = rng.normal(size=(30, 8))
    layer = np.array([0, 0, 0, 0, 1, 1, 1, 2])
    assert near_extremes.find(basis, layer) == []
    basis[:, 2] = basis[:, 0] + 0.02 * basis[:, 1]
    basis[:, 6] = basis[:, 4] + 0.001 * basis[:, 5]
    basis[:, 7] = basis[:, 0]  # another layer's
    found = near_extremes.find(basis, layer)
    assert [pair[:2] for pair in found] == [(0, 2), (4, 6)]
    assert 0.01 < found[0].share < 0.05 and found[1].share < 0.002
    large = near_extremes.find(100 * basis, layer)
    np.testing.assert_allclose(large, found)


def test_a_layer_of_equals_is_near_throughout():
    found = near_extremes.find(np.ones((4, 3)), np.zeros(3, int))
    assert [pair[:2] for pair in found] == [(0, 1), (0, 2), (1, 2)]
    with pytest.raises(ValueError, match=r"layer \(2,\)"):
        near_extremes.find(np.ones((4, 3)), np.zeros(2, int))
