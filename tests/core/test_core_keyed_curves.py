import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import keyed_curves


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**32 - 1), st.integers(2, 40), st.integers(1, 4), st.data())
def test_errors_and_neighbours_stay_those_of_the_keys(seed, frames, count, data):
    rng = np.random.default_rng(seed)
    values = rng.normal(size=(frames, count))
    kept = rng.uniform(size=(frames, count)) < 0.5
    kept[[0, -1]] = True
    curves = keyed_curves.KeyedCurves(values, kept)
    for _ in range(data.draw(st.integers(0, 30))):
        channel = data.draw(st.integers(0, count - 1))
        frame = data.draw(st.integers(0, frames - 1))
        if not curves.kept[channel, frame]:
            curves.insert(channel, frame)
        elif 0 < frame < frames - 1:
            low, high = curves.before[channel, frame], curves.after[channel, frame]
            line = curves.line(channel, low, high)
            curves.remove(channel, frame, low, high, line)
    for channel in range(count):
        rows = np.flatnonzero(curves.kept[channel])
        truth = keyed_curves.error(values[:, channel], curves.kept[channel])
        np.testing.assert_allclose(curves.wrong[channel], truth, atol=1e-12)
        np.testing.assert_array_equal(curves.after[channel, rows[:-1]], rows[1:])
        np.testing.assert_array_equal(curves.before[channel, rows[1:]], rows[:-1])
        keys, off = curves.inner(channel)
        np.testing.assert_array_equal(keys, rows[1:-1])
        lines = [curves.line(channel, a, b) for a, b in zip(rows, rows[2:], strict=False)]
        np.testing.assert_allclose(off, [np.abs(line).max() for line in lines])


def test_a_key_that_is_one_already_changes_nothing():
    curves = keyed_curves.KeyedCurves(np.arange(4.0)[:, None], np.ones((4, 1), bool))
    assert curves.insert(0, 2) == (2, 2)
    assert curves.kept.all()
