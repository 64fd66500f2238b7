import numpy as np
import pytest

from stages.core import lip_closeness


def test_the_papers_gamma():
    gap = np.array([0.0, 0.1, 0.13, 0.2, np.nan])
    gamma = lip_closeness.closeness(gap, 0.1, 0.03)
    np.testing.assert_allclose(gamma, [1, 1, np.exp(-0.5), np.exp(-(0.1**2) / 0.0018), 0])


def test_the_steep_one_decides_at_sigma():
    gap = np.array([0.0, 0.1, 0.112, 0.13, 0.16, 0.3, np.nan])
    near = lip_closeness.steep(gap, 0.1, 0.03)
    np.testing.assert_allclose(near[[0, 1, 3, 6]], [1, 1, 0.5, 0], atol=1e-12)
    odds = near[[2, 4]] / (1 - near[[2, 4]])
    np.testing.assert_allclose(odds, [(0.03 / 0.012) ** 8, 0.5**8], rtol=1e-6)
    assert np.all(np.diff(near[1:6]) < 0)
    np.testing.assert_array_equal(lip_closeness.steep(gap, 0.1, 1e-60), [1, 1, 0, 0, 0, 0, 0])


@pytest.mark.parametrize("rule", [lip_closeness.closeness, lip_closeness.steep])
@pytest.mark.parametrize(("closed", "sigma"), [(0.1, 0.0), (0.1, -1.0), (np.nan, 0.1)])
def test_bad_numbers_are_refused(rule, closed, sigma):
    with pytest.raises(ValueError, match="must be above 0"):
        rule(np.zeros(2), closed, sigma)
