import ast
import pathlib

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from stages.core import layer_kernel

CORE = pathlib.Path(layer_kernel.__file__).parent
GROUP = np.repeat([0, 1, 2], (4, 3, 1))


def quadratic(rng, rank):
    factor = rng.normal(size=(rank, len(GROUP)))
    return factor.T @ factor, rng.normal(size=len(GROUP))


def started(rng):
    start = rng.exponential(size=len(GROUP)) * (rng.uniform(size=len(GROUP)) > 0.4)
    start[[0, 4, 7]] += 0.1
    return start / np.bincount(GROUP, start)[GROUP]


@hypothesis.given(seed=st.integers(0, 2**32 - 1), rank=st.integers(1, 8))
@hypothesis.settings(deadline=None)
def test_minimises_a_quadratic_over_simplices(seed, rank):
    rng = np.random.default_rng(seed)
    hessian, linear = quadratic(rng, rank)
    point = started(rng)
    gradient = hessian @ point + linear
    assert layer_kernel.minimise_quadratic(hessian, gradient, GROUP, point, 1e-12, 1e-12)
    assert np.all(point >= 0)
    np.testing.assert_allclose(np.bincount(GROUP, point), 1)
    np.testing.assert_allclose(gradient, hessian @ point + linear, atol=1e-8)
    # optimal: nothing that has weight costs more than the cheapest of its simplex
    least = np.array([gradient[group == GROUP].min() for group in range(3)])
    assert (gradient - least[GROUP]) @ point < 1e-7


def test_says_that_a_quadratic_is_not_convex():
    point = np.array([0.5, 0.5])
    answer = layer_kernel.minimise_quadratic(
        -np.eye(2), np.zeros(2), np.zeros(2, int), point, 1e-9, 0.0
    )
    assert not answer


@hypothesis.given(st.lists(st.floats(-10, 10, width=32), min_size=4, max_size=4))
@hypothesis.settings(deadline=None)
def test_lowest_place_of_a_quartic(terms):
    c = np.array([0.0, *terms])
    place = layer_kernel._lowest(c)
    grid = np.linspace(0, 1, 501)
    assert 0 <= place <= 1
    assert np.polyval(c[::-1], place) <= np.polyval(c[::-1], grid).min() + 1e-6


@pytest.mark.parametrize("overlap", [False, True])
def test_derivatives_are_those_of_the_displacements(overlap):
    rng = np.random.default_rng(0)
    masks, layer = 2, np.array([1, 0, 1, 0, 0])
    count, layers = len(layer), 2
    pairs = np.array([[a, b] for a in range(masks) for b in range(masks) if overlap or a == b])
    factor = rng.normal(size=(30, masks * count))
    gram = factor.T @ factor
    if not overlap:
        gram[:count, count:] = gram[count:, :count] = 0.0
    first = np.repeat([0, 1], count) * layers + np.tile(layer, masks)
    second = masks * layers + np.tile(np.arange(count), masks)
    point = rng.uniform(size=masks * layers + count)
    hessian = layer_kernel._gauss_newton(gram, pairs, first, point, count)
    slopes = np.zeros((masks * count, len(point)))
    slopes[np.arange(len(first)), first] = point[second]
    slopes[np.arange(len(first)), second] = point[first]
    np.testing.assert_allclose(hessian, 2 * slopes.T @ gram @ slopes)
    vector = rng.normal(size=masks * count)
    np.testing.assert_allclose(layer_kernel._times(gram, pairs, vector, count), gram @ vector)


def test_no_kernel_calls_one_of_another_file():
    # numba's cache looks at a function's own file only: it would not see the other one change
    kernels = 0
    for path in sorted(CORE.glob("layer_*.py")):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.FunctionDef) and "njit" in ast.unparse(node.decorator_list[:1]):
                names = {name.id for name in ast.walk(node) if isinstance(name, ast.Name)}
                assert not {name for name in names if name.startswith("layer_")}
                kernels += 1
    assert kernels > 10
