import numpy as np
import pytest

from stages.core import lip_closeness


def test_the_papers_gamma():
    gap = np.array([0.0, 0.1, 0.13, 0.2, np.nan])
    gamma = lip_closeness.closeness(gap, 0.1, 0.03)
    np.testing.assert_allclose(gamma, [1, 1, np.exp(-0.5), np.exp(-(0.1**2) / 0.0018), 0])


@pytest.mark.parametrize(("closed", "sigma"), [(0.1, 0.0), (0.1, -1.0), (np.nan, 0.1)])
def test_bad_numbers_are_refused(closed, sigma):
    with pytest.raises(ValueError, match="must be above 0"):
        lip_closeness.closeness(np.zeros(2), closed, sigma)
