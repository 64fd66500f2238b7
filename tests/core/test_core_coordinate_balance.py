import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import coordinate_balance

GROUP = np.repeat([0, 1], [12, 6])
MASKS = np.zeros((3, 18))
MASKS[[0, 1, 2] * 6, np.arange(18)] = 1
MASKS[:, 4] = 0.5, 0.5, 0


def basis(seed, sizes=(1.0, 1.0)):
    return np.random.default_rng(seed).normal(size=(18, 5)) * np.array(sizes)[GROUP][:, None]


def balanced(drawn, rule, masks=MASKS):
    return coordinate_balance.factors(drawn, GROUP, masks, rule)[:, None] * drawn


@given(
    st.integers(0, 100),
    st.floats(1e-3, 1e3),
    st.floats(1e-3, 1e3),
    st.sampled_from(coordinate_balance.RULES),
)
def test_a_mean_extreme_has_length_one(seed, first, second, rule):
    drawn = basis(seed, (first, second))
    found = balanced(drawn, rule)
    assert np.mean(np.sum(found**2, axis=0)) == pytest.approx(1)
    np.testing.assert_allclose(balanced(100 * drawn, rule), found, rtol=1e-12)


def test_variance_makes_the_kinds_equal_and_published_leaves_them():
    drawn = basis(0, (1.0, 40.0))
    of_each = {
        rule: np.bincount(GROUP, np.mean(balanced(drawn, rule) ** 2, axis=1))
        for rule in ("variance", "published")
    }
    np.testing.assert_allclose(of_each["variance"], [0.5, 0.5])
    raw = np.bincount(GROUP, np.mean(drawn**2, axis=1))
    np.testing.assert_allclose(of_each["published"], raw / raw.sum())
    np.testing.assert_allclose(balanced(drawn, "mask_variance", np.ones((1, 18))),
                               balanced(drawn, "variance"))  # fmt: skip


def test_mask_variance_makes_what_lies_under_each_mask_equal():
    """Also where a coordinate lies under two."""
    drawn = basis(0, (1.0, 40.0)) * np.where(MASKS[2] == 1, 0.2, 1.0)[:, None]
    squares = np.mean(balanced(drawn, "mask_variance") ** 2, axis=1)
    hard = MASKS.copy()
    hard[:, 4] = 0, 1, 0
    squares_hard = np.mean(balanced(drawn, "mask_variance", hard) ** 2, axis=1)
    for number in range(2):
        own = number == GROUP
        np.testing.assert_allclose(hard[:, own] @ squares_hard[own], 1 / 6)
        np.testing.assert_allclose((MASKS[2] * own) @ squares, 1 / 6)
    assert squares.sum() == pytest.approx(1)


def test_what_hardly_moves_is_not_blown_up():
    drawn = basis(0) * np.where(MASKS[2] == 1, 1e-6, 1.0)[:, None]
    squares = np.mean(balanced(drawn, "mask_variance") ** 2, axis=1)
    assert MASKS[2] @ squares < 1e-8
    none = np.where(MASKS[2] == 1, 0.0, basis(0).T).T
    assert np.isfinite(balanced(none, "mask_variance")).all()


@pytest.mark.parametrize("rule", ["variance", "mask_variance"])
def test_units_of_one_kind_do_not_matter_under_variance(rule):
    np.testing.assert_allclose(
        balanced(basis(0), rule), balanced(basis(0, (1.0, 25.4)), rule), rtol=1e-12
    )


def test_bad_arrays_are_refused():
    with pytest.raises(ValueError, match="groups \\[1\\] are the same"):
        coordinate_balance.factors(basis(0, (1.0, 0.0)), GROUP, MASKS, "variance")
    with pytest.raises(ValueError, match="no rule 'mean'"):
        coordinate_balance.factors(basis(0), GROUP, MASKS, "mean")
    with pytest.raises(ValueError, match="group \\(4,\\)"):
        coordinate_balance.factors(basis(0), GROUP[:4], MASKS, "variance")
