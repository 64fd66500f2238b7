import numpy as np
import pytest

from stages.core import layer_composition


def test_a_face_is_the_papers_sum():
    """Equation 4, point by point."""
    rng = np.random.default_rng(0)
    layer, masks = np.array([0, 0, 1, 1, 1]), rng.dirichlet(np.ones(2), 6).T
    basis, weights = rng.normal(size=(6, 5)), rng.random((3, 2, 2))
    coefficients, amplitudes = rng.random((3, 5)), rng.random((3, 2))
    u = layer_composition.displacements(layer, weights, coefficients, amplitudes)
    found = layer_composition.composed(basis, masks, u)
    for t, d in np.ndindex(3, 6):
        expected = sum(
            masks[m, d] * weights[t, m, layer[k]] * amplitudes[t, m] * coefficients[t, k]
            * basis[d, k] for m in range(2) for k in range(5)
        )  # fmt: skip
        assert found[t, d] == pytest.approx(expected)


def test_bad_arrays_are_refused():
    with pytest.raises(ValueError, match="do not fit"):
        layer_composition.composed(np.ones((6, 5)), np.ones((2, 6)), np.ones((3, 3, 5)))
