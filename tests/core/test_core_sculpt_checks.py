import numpy as np
import pytest

from stages.core import sculpt_checks


@pytest.fixture
def neutral():
    return np.random.default_rng(0).uniform(-1, 1, (60, 3)) * [0.8, 1.0, 0.9]


def expression(neutral):
    """Open the lower half."""
    return neutral - np.where(neutral[:, 1:2] < -0.6, [0.0, 0.3, 0.0], 0.0)


def test_a_sculpt_in_place_has_no_fault(neutral):
    assert sculpt_checks.placement_fault(expression(neutral), neutral) is None


@pytest.mark.parametrize("factor", [10, 0.1, 100, 0.01, 1000, 0.001, 2.54, 1 / 2.54, 30.48])
def test_another_unit_is_named(neutral, factor):
    what, cure = sculpt_checks.placement_fault(expression(neutral) * factor, neutral)
    assert f"{max(factor, 1 / factor):g} times {'larger' if factor > 1 else 'smaller'}" in what
    assert "unit" in cure


def test_other_sizes_axes_and_places_are_named(neutral):
    sculpt = expression(neutral)
    assert "bounding box" in sculpt_checks.placement_fault(sculpt * 5, neutral)[0]
    z_up = np.stack([sculpt[:, 0], -sculpt[:, 2], sculpt[:, 1]], axis=1)
    assert "axis" in sculpt_checks.placement_fault(z_up, neutral)[0]
    assert (
        "moved as a whole"
        in sculpt_checks.placement_fault(sculpt + np.array([0, 0.4, 0]), neutral)[0]
    )


def test_equality_is_relative_to_size(neutral):
    size = sculpt_checks.diagonal(neutral)
    assert sculpt_checks.equal(neutral, neutral + 1e-8, size)
    assert not sculpt_checks.equal(neutral, neutral + 1e-4, size)
    assert sculpt_checks.equal(1000 * neutral, 1000 * neutral + 1e-4, 1000 * size)
