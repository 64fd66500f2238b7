import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import coordinate_balance

GROUP = np.repeat([0, 1], [12, 6])


def basis(seed, sizes=(1.0, 1.0)):
    return np.random.default_rng(seed).normal(size=(18, 5)) * np.array(sizes)[GROUP][:, None]


@given(
    st.integers(0, 100),
    st.floats(1e-3, 1e3),
    st.floats(1e-3, 1e3),
    st.sampled_from(coordinate_balance.RULES),
)
def test_a_mean_extreme_has_length_one(seed, first, second, rule):
    drawn = basis(seed, (first, second))
    balanced = coordinate_balance.factors(drawn, GROUP, rule)[:, None] * drawn
    assert np.mean(np.sum(balanced**2, axis=0)) == pytest.approx(1)
    again = coordinate_balance.factors(100 * drawn, GROUP, rule)[:, None] * 100 * drawn
    np.testing.assert_allclose(again, balanced, rtol=1e-12)


def test_variance_makes_the_kinds_equal_and_published_leaves_them():
    drawn = basis(0, (1.0, 40.0))
    of_each = {}
    for rule in coordinate_balance.RULES:
        balanced = coordinate_balance.factors(drawn, GROUP, rule)[:, None] * drawn
        of_each[rule] = np.bincount(GROUP, np.mean(balanced**2, axis=1))
    np.testing.assert_allclose(of_each["variance"], [0.5, 0.5])
    raw = np.bincount(GROUP, np.mean(drawn**2, axis=1))
    np.testing.assert_allclose(of_each["published"], raw / raw.sum())


def test_units_of_one_kind_do_not_matter_under_variance():
    drawn, other = basis(0), basis(0, (1.0, 25.4))
    np.testing.assert_allclose(
        coordinate_balance.factors(drawn, GROUP, "variance")[:, None] * drawn,
        coordinate_balance.factors(other, GROUP, "variance")[:, None] * other,
    )


def test_bad_arrays_are_refused():
    with pytest.raises(ValueError, match="groups \\[1\\] are the same"):
        coordinate_balance.factors(basis(0, (1.0, 0.0)), GROUP, "variance")
    with pytest.raises(ValueError, match="no rule 'mean'"):
        coordinate_balance.factors(basis(0), GROUP, "mean")
    with pytest.raises(ValueError, match="group \\(4,\\)"):
        coordinate_balance.factors(basis(0), GROUP[:4], "variance")
