import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import vertex_texture


@settings(deadline=None, max_examples=60)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([*vertex_texture.SCALINGS]),
    st.sampled_from([("half", np.float16), ("float", np.float32)]),
    st.floats(1e-6, 1e6),
)
def test_rounded_pixels_stay_within_the_stated_error(seed, mode, depth, size):
    rng = np.random.default_rng(seed)
    moved = size * rng.normal(size=(50, 3)) * rng.uniform(0, 1, 3)
    scaling = vertex_texture.SCALINGS[mode](moved.min(axis=0), moved.max(axis=0))
    pixels = vertex_texture.encode(moved, scaling)
    assert np.abs(pixels).max() <= 1
    name, dtype = depth
    back = scaling.offset + scaling.gain * pixels.astype(dtype).astype(float)
    bound = scaling.gain * vertex_texture.ROUNDING[name]
    assert (np.abs(back - moved) <= bound * (1 + 1e-6)).all()


def test_what_rests_is_exactly_zero_by_the_greatest_deviation():
    scaling = vertex_texture.max_deviation(np.array([-1.0, 0, 0.3]), np.array([0.5, 0.2, 3]))
    np.testing.assert_array_equal(vertex_texture.encode(np.zeros(3), scaling), 0)
    assert scaling.gain.tolist() == [3, 3, 3]


@pytest.mark.parametrize("mode", vertex_texture.SCALINGS)
def test_a_still_take_has_finite_pixels(mode):
    scaling = vertex_texture.SCALINGS[mode](np.zeros(3), np.zeros(3))
    np.testing.assert_array_equal(vertex_texture.encode(np.zeros((2, 3)), scaling), 0)


@settings(deadline=None, max_examples=100)
@given(st.integers(1, 40_000), st.integers(1, 1500))
def test_openvats_sides_are_powers_of_two_that_hold_all(vertices, frames):
    width, height = vertex_texture.openvat_size(vertices, frames)
    assert width in vertex_texture.SIDES and height & (height - 1) == 0
    assert frames * -(-vertices // width) <= height <= 8192
    assert 0.5 <= height / width <= 2


def test_too_much_for_openvat_is_said():
    with pytest.raises(ValueError, match="5000 frames of 26719 vertices do not fit 8192 x 8192"):
        vertex_texture.openvat_size(26_719, 5_000)


@given(st.integers(1, 30), st.integers(1, 9), st.integers(1, 6))
def test_every_frame_and_block_has_a_row_of_its_own(frames, blocks, width):
    frame, block = np.ogrid[:frames, :blocks]
    for rows in (
        vertex_texture.plain_rows(frame, block, blocks),
        vertex_texture.openvat_rows(frame, block, frames),
    ):
        assert sorted(rows.ravel()) == list(range(frames * blocks))
    places = vertex_texture.lookup(blocks * width, width, frames * blocks, rows[0])
    assert len({(u, v) for u, v in places.tolist()}) == blocks * width
    assert (places > 0).all() and (places < 1).all()
