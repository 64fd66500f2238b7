import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import curve_keys


@given(st.lists(st.sampled_from([0.0, 0.3, 1.0]), min_size=1, max_size=40))
def test_the_keys_give_every_frame_back_and_none_is_idle(values):
    curve = np.array(values)
    rows = curve_keys.needed(curve)
    np.testing.assert_array_equal(np.interp(np.arange(len(curve)), rows, curve[rows]), curve)
    for place in range(1, len(rows) - 1):
        assert len(set(curve[rows[place - 1] : rows[place + 1] + 1])) > 1
    assert len(rows) == 1 or len(set(values)) > 1


def test_no_value_is_refused():
    with pytest.raises(ValueError, match="at least one frame"):
        curve_keys.needed(np.zeros(0))
