import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stages.core import compose, douglas_peucker, key_reduction, local_shapes, mesh_error


def drawn(seed, frames, count, vertices=40):
    """Return smooth and noisy curves, and dense shapes that reach some vertices each."""
    rng = np.random.default_rng(seed)
    times = np.arange(frames)[:, None]
    waves = np.sin(times * rng.uniform(0.02, 0.6, count) + rng.uniform(0, 6, count))
    values = waves * rng.uniform(0, 1, count) + rng.uniform(0, 0.05) * rng.normal(
        size=(frames, count)
    )
    deltas = rng.normal(size=(count, vertices, 3)) * rng.uniform(0.1, 3, (count, 1, 1))
    return values, deltas * (rng.uniform(size=(count, vertices, 1)) < 0.5)


def displaced(values, kept, deltas):
    """Evaluate the bound anew: both sets of curves at frames and half frames, dense shapes."""
    frames = np.arange(len(values))
    times = np.arange(2 * len(values) - 1) / 2
    wrong = np.stack(
        [
            np.interp(times, frames[keys], curve[keys]) - np.interp(times, frames, curve)
            for curve, keys in zip(values.T, kept.T, strict=True)
        ],
        axis=1,
    )
    return np.linalg.norm(np.einsum("tk,kvd->tvd", wrong, deltas), axis=2).max()


def common_rdp(values, tolerance):
    keys = [douglas_peucker.keys(curve, tolerance) for curve in values.T]
    return np.stack([np.isin(np.arange(len(values)), rows) for rows in keys], axis=1)


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 2**32 - 1), st.integers(1, 60), st.integers(1, 8), st.floats(1e-4, 2))
def test_no_vertex_moves_farther_at_frames_and_half_frames(seed, frames, count, tolerance):
    values, deltas = drawn(seed, frames, count)
    kept, worst = key_reduction.reduce(values, local_shapes.gather(deltas), tolerance)
    assert kept.shape == values.shape
    assert kept[[0, -1]].all()
    assert worst <= tolerance
    assert displaced(values, kept, deltas) == pytest.approx(worst, rel=1e-6, abs=1e-12)


def test_few_watched_vertices_are_enough_for_many():
    values, deltas = drawn(4, 120, 10, vertices=1500)
    kept, worst = key_reduction.reduce(values, local_shapes.gather(deltas), 0.2)
    assert displaced(values, kept, deltas) == pytest.approx(worst, rel=1e-6)
    assert 0.15 < worst <= 0.2


@pytest.mark.parametrize("slope", [0.0, 0.02, -0.5])
def test_constant_and_linear_curves_have_two_keys(slope):
    values = 0.3 + slope * np.arange(50)[:, None] * np.array([1.0, 0.0, 2.0])
    shapes = local_shapes.gather(drawn(0, 1, 3)[1])
    kept, _ = key_reduction.reduce(values, shapes, 1e-6)
    np.testing.assert_array_equal(kept.sum(axis=0), 2)


def test_a_channel_that_moves_nothing_has_two_keys_and_a_frame_one():
    values, deltas = drawn(1, 30, 2)
    deltas[1] = 0
    shapes = local_shapes.gather(deltas)
    kept, _ = key_reduction.reduce(values, shapes, 1e-9)
    np.testing.assert_array_equal(kept.sum(axis=0), [30, 2])
    np.testing.assert_array_equal(key_reduction.reduce(values[:1], shapes, 0.1)[0], [[1, 1]])


@pytest.mark.parametrize("seed", range(4))
def test_there_are_fewer_keys_than_rdp_on_curves_has_at_the_same_error(seed):
    values, deltas = drawn(seed, 150, 6)
    shapes = local_shapes.gather(deltas)
    parts = compose.blocks(shapes)
    for tolerance in (0.01, 0.05):
        published = common_rdp(values, tolerance)
        worst = mesh_error.worst(parts, key_reduction.error(values, published))[0].max()
        assert worst == pytest.approx(displaced(values, published, deltas))
        kept, _ = key_reduction.reduce(values, shapes, worst)
        assert kept.sum() < published.sum()


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 2**32 - 1), st.integers(1, 80), st.floats(0, 1))
def test_rdp_keeps_a_curve_within_its_tolerance(seed, frames, tolerance):
    values = drawn(seed, frames, 1)[0][:, 0]
    rows = douglas_peucker.keys(values, tolerance)
    line = np.interp(np.arange(frames), rows, values[rows])
    assert np.abs(line - values).max() <= tolerance + 1e-12


def test_rdp_takes_the_farthest_point_first():
    values = np.array([0, 0, 0, 3, 0, 0, 1, 0], float)
    np.testing.assert_array_equal(douglas_peucker.keys(values, 2.5), [0, 3, 7])


def test_the_worst_vertex_is_that_of_a_dense_product():
    rng = np.random.default_rng(7)
    deltas = rng.normal(size=(4, 700, 3)) * (rng.uniform(size=(4, 700, 1)) < 0.1)
    wrong = rng.normal(size=(600, 4))
    lengths = np.linalg.norm(np.einsum("tk,kvd->tvd", wrong, deltas), axis=2)
    largest, vertex = mesh_error.worst(compose.blocks(local_shapes.gather(deltas)), wrong)
    np.testing.assert_allclose(largest, lengths.max(axis=1))
    np.testing.assert_array_equal(vertex, lengths.argmax(axis=1))


@pytest.mark.parametrize(
    ("frames", "count", "tolerance"), [(5, 2, 0.0), (5, 2, np.nan), (5, 3, 1.0), (0, 2, 1.0)]
)
def test_what_cannot_be_reduced_is_refused(frames, count, tolerance):
    shapes = local_shapes.gather(np.ones((2, 4, 3)))
    with pytest.raises(ValueError, match="cannot reduce"):
        key_reduction.reduce(np.zeros((frames, count)), shapes, tolerance)
