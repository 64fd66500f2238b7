import hypothesis
import hypothesis.extra.numpy
import hypothesis.strategies as st
import numpy as np
import pytest

from stages.core import multiresolution

CURVES = hypothesis.extra.numpy.arrays(
    float,
    st.tuples(st.integers(1, 70), st.integers(1, 3)),
    elements=st.floats(-1e3, 1e3, allow_nan=False),
)
RATES = [24, 25, 30, 50, 59.94, 60, 100, 120, 240]


def low_passed(values, rate, cutoff):
    levels = multiresolution.levels_above(rate, cutoff, len(values))
    cutoffs = np.full(values.shape[1], cutoff)
    gains = multiresolution.gains_below(rate, cutoffs, levels)
    return multiresolution.filtered(values, gains)


def wave(rate, frequency, seconds=8):
    return np.cos(2 * np.pi * frequency * np.arange(int(seconds * rate)) / rate)[:, None]


def passed(rate, frequency, cutoff):
    made, truth = low_passed(wave(rate, frequency), rate, cutoff), wave(rate, frequency)
    inner = slice(len(truth) // 4, -len(truth) // 4)
    return np.sum(made[inner] * truth[inner]) / np.sum(truth[inner] ** 2)


@hypothesis.given(CURVES, st.integers(0, 8))
def test_unit_gains_return_the_input_to_rounding(values, levels):
    made = multiresolution.filtered(values, np.ones((levels, values.shape[1])))
    np.testing.assert_allclose(made, values, rtol=0, atol=1e-12 * (1 + np.abs(values).max()))


@hypothesis.given(CURVES, st.integers(1, 6), st.integers(0, 2**32 - 1))
def test_a_curve_run_backwards_gives_the_result_backwards(values, levels, seed):
    gains = np.random.default_rng(seed).uniform(0, 2, (levels, values.shape[1]))
    forwards = multiresolution.filtered(values, gains)
    backwards = multiresolution.filtered(values[::-1], gains)[::-1]
    np.testing.assert_allclose(forwards, backwards, rtol=0, atol=1e-9)


@hypothesis.given(CURVES, st.floats(0.5, 40))
def test_what_is_smoothed_stays_within_its_range(values, cutoff):
    made = low_passed(values, 60, cutoff)
    slack = 1e-12 * (1 + np.abs(values).max())
    assert (made >= values.min(axis=0) - slack).all()
    assert (made <= values.max(axis=0) + slack).all()


@hypothesis.given(CURVES, st.integers(1, 6), st.integers(0, 2**32 - 1))
def test_the_filter_is_the_formula_of_bruderlin_and_williams(values, levels, seed):
    gains = np.random.default_rng(seed).uniform(0, 2, (levels, values.shape[1]))
    last = max(len(values) - 1, 1)
    mirror = np.abs((np.arange(-300, len(values) + 300) + last) % (2 * last) - last)
    smooth = [values[mirror] if len(values) > 1 else np.repeat(values, 601, axis=0)]
    for level in range(levels):
        kernel = np.zeros(4 * 2**level + 1)
        kernel[:: 2**level] = np.array([1, 4, 6, 4, 1]) / 16
        columns = [np.convolve(column, kernel, "same") for column in smooth[-1].T]
        smooth.append(np.stack(columns, axis=1))
    expected = smooth[-1].copy()
    for level in range(levels):
        expected += gains[level] * (smooth[level] - smooth[level + 1])
    made = multiresolution.filtered(values, gains)
    np.testing.assert_allclose(made, expected[300 : 300 + len(values)], rtol=0, atol=1e-9)


def test_a_straight_line_is_kept_away_from_the_ends():
    line = np.linspace(-3, 5, 400)[:, None]
    made = low_passed(line, 120, 10)
    np.testing.assert_allclose(made[6:-6], line[6:-6], atol=1e-12)


@pytest.mark.parametrize("rate", RATES)
def test_an_edge_is_where_half_is_passed(rate):
    found = multiresolution.edges(rate, 3)
    assert found[0] == rate / 2
    assert (np.diff(found) < 0).all()
    for level in (1, 2, 3):
        curve = wave(rate, found[level])
        made = multiresolution.filtered(curve, np.zeros((level, 1)))
        inner = slice(len(curve) // 4, -len(curve) // 4)
        assert np.sum(made[inner] * curve[inner]) / np.sum(curve[inner] ** 2) == pytest.approx(
            0.5, abs=0.01
        )


@pytest.mark.parametrize("rate", [rate for rate in RATES if rate >= 50])
def test_bands_are_named_in_hertz_whatever_the_rate(rate):
    assert passed(rate, 2, 10) > 0.95
    assert 0.3 < passed(rate, 10, 10) < 0.7
    assert passed(rate, 22, 10) < 0.16
    assert passed(rate, 2, 5) < passed(rate, 2, 10)
    assert passed(rate, 0.1, 1) > 0.98
    assert passed(rate, 6, 1) < 0.01


def test_one_band_can_be_taken_alone():
    found = multiresolution.edges(120, 4)
    gains = np.array([[1.0], [0.0], [1.0], [1.0]])
    for level, kept in ((0, True), (1, False), (3, True)):
        middle = np.sqrt(found[level] * found[level + 1])
        curve = wave(120, middle)
        made = multiresolution.filtered(curve, gains)
        assert (np.abs(made[100:-100]).max() > 0.7) == kept


def test_channels_are_filtered_each_by_its_own_gain():
    rng = np.random.default_rng(0)
    values = rng.standard_normal((50, 3 * multiresolution.COLUMNS))
    gains = rng.uniform(size=(3, values.shape[1]))
    made = multiresolution.filtered(values, gains)
    for column in (0, multiresolution.COLUMNS, values.shape[1] - 1):
        alone = multiresolution.filtered(values[:, [column]], gains[:, [column]])
        np.testing.assert_allclose(made[:, [column]], alone, atol=1e-14)


def test_bad_arrays_are_refused():
    with pytest.raises(ValueError, match=r"values \(5, 2\) and gains \(3, 1\)"):
        multiresolution.filtered(np.zeros((5, 2)), np.ones((3, 1)))
    with pytest.raises(ValueError, match=r"values \(2, 1\) are not all finite"):
        multiresolution.filtered(np.array([[0.0], [np.nan]]), np.ones((3, 1)))
