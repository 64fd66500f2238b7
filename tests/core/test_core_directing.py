import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stages.core import directing

TIMES = np.linspace(-1, 11, 25)


def test_weights_are_the_product_of_their_factors():
    rng = np.random.default_rng(0)
    frames, masks, layers, layer = 5, 2, 3, np.array([0, 0, 1, 2, 0])
    weights = rng.uniform(size=(frames, masks, layers))
    coefficients, gain = rng.uniform(size=(2, frames, len(layer)))
    amplitudes, none = rng.uniform(1, 2, size=(frames, masks)), np.full(layers, -1)
    found = directing.composed(weights, coefficients, amplitudes, layer, gain, none)
    assert found.shape == (frames, masks, len(layer))
    for t in range(frames):
        for mask in range(masks):
            for k, j in enumerate(layer):
                wanted = weights[t, mask, j] * coefficients[t, k] * amplitudes[t, mask] * gain[t, k]
                np.testing.assert_allclose(found[t, mask, k], wanted, rtol=1e-14)
    with pytest.raises(ValueError, match=r"weights \(5, 2, 3\).*do not fit"):
        directing.composed(weights, coefficients, amplitudes[:, :1], layer, gain, none)


def test_what_gains_take_goes_to_the_layers_neutral():
    """So the sum under a mask stays one, whatever gains up to one say."""
    rng = np.random.default_rng(1)
    layer, rest = np.array([0, 0, 0, 1, 1]), np.array([1, -1])
    coefficients = np.hstack([rng.dirichlet(np.ones(3), 6), rng.dirichlet(np.ones(2), 6)])
    weights, gain = rng.dirichlet(np.ones(2), (6, 2)), rng.uniform(size=(6, 5))
    factors = weights, coefficients, np.ones((6, 2)), layer
    found = directing.composed(*factors, gain, rest)
    np.testing.assert_allclose(found[:, :, :3].sum(axis=2), weights[:, :, 0], rtol=1e-12)
    plain = directing.composed(*factors, gain, np.full(2, -1))
    np.testing.assert_array_equal(found[:, :, [0, 2, 3, 4]], plain[:, :, [0, 2, 3, 4]])
    away = directing.composed(*factors, np.zeros((6, 5)), rest)
    np.testing.assert_allclose(away[:, :, 1], weights[:, :, 0], rtol=1e-12)
    assert not away[:, :, [0, 2, 3, 4]].any()


@given(st.floats(-2, 8), st.floats(0.01, 8), st.floats(0, 0.5), st.floats(0, 3), st.floats(0, 1e-3))
def test_gains_fade_within_their_range_without_a_jump(start, length, share, gain, step):
    end, fade = start + length, share * length
    row = directing.Direction(np.array([1]), gain, start, end, fade)
    times = np.linspace(start - 1, end + 1, 101)
    found = directing.gains(times, 3, [row])
    assert (found[:, [0, 2]] == 1.0).all()
    outside = (times < start) | (times > end)
    assert (found[outside, 1] == 1.0).all()
    full = (times >= start + fade) & (times <= end - fade) & (times < end)
    np.testing.assert_allclose(found[full, 1], gain, atol=1e-6)
    assert (found[:, 1] >= min(gain, 1.0) - 1e-12).all()
    assert (found[:, 1] <= max(gain, 1.0) + 1e-12).all()
    if fade > 0.05:
        jump = directing.gains(times + step, 3, [row])[:, 1] - found[:, 1]
        # the smoothstep rises by 1.5 of its length at most
        assert np.abs(jump).max() <= 1.5 * step / fade * abs(gain - 1.0) + 1e-9


def test_a_fade_is_the_smoothstep():
    found = directing.presence(np.array([2.0, 2.25, 2.5, 3.0, 4.0, 5.75]), 2.0, 6.0, 1.0)
    np.testing.assert_allclose(found, [0, 0.15625, 0.5, 1, 1, 0.15625])
    found = directing.presence(np.array([1.0, 2.0, 5.9, 6.0]), 2.0, 6.0, 0.0)
    np.testing.assert_array_equal(found, [0, 1, 1, 0])


def test_rows_multiply_and_open_ends_do_not_fade():
    everywhere = directing.Direction(np.array([0, 1]), 0.5, -np.inf, np.inf, 1.0)
    late = directing.Direction(np.array([1]), 3.0, 5.0, np.inf, 1.0)
    found = directing.gains(TIMES, 2, [everywhere, late])
    np.testing.assert_array_equal(found[:, 0], 0.5)
    np.testing.assert_allclose(found[TIMES >= 6, 1], 1.5)
    np.testing.assert_array_equal(found[TIMES <= 5, 1], 0.5)
    none = directing.Direction(np.array([], int), 3.0, 5.0, np.inf, 1.0)
    assert (directing.gains(TIMES, 2, [none]) == 1.0).all()


@pytest.mark.parametrize(
    ("span", "message"),
    [
        ((3, 2, 0), "2 s, is not after the start, 3 s"),
        ((2, 2, 0), "is not after the start"),
        ((2, 3, 0.6), "leaves no room"),
        ((2, 3, -0.1), "a fade of -0.1 s is negative"),
    ],
)
def test_ranges_without_room_are_refused(span, message):
    with pytest.raises(ValueError, match=message):
        directing.presence(TIMES, *span)
