import numpy as np
import pytest

from stages.core import layer_solver


@pytest.mark.parametrize("rate", [15, 30, 60, 120])
def test_temporal_weight_forgets_alike_at_all_rates(rate):
    weight = layer_solver.temporal_at(rate, 0.05)
    kept = (weight / (1 + weight)) ** (rate / 30)
    assert kept == pytest.approx(0.05 / 1.05)
    assert layer_solver.temporal_at(rate, 0.0) == 0.0


@pytest.mark.parametrize(("rate", "weight"), [(0, 0.1), (30, -0.1), (np.nan, 0.1), (30, np.inf)])
def test_refuses_a_rate_or_weight_without_meaning(rate, weight):
    with pytest.raises(ValueError, match="rate"):
        layer_solver.temporal_at(rate, weight)
