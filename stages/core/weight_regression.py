"""Regression from coordinates on principal axes to the weights of blendshapes (D06 section 6).

One function serves every method:
``F(x) = constant + linear' x + sum_k w_k exp(-|x - c_k|^2 / 2 width^2)``.
`rbf` is the published network, without the first two terms; `linear` is a plain ridge, without the
last; `rbf_linear` has all of them.
"""

from typing import NamedTuple

import numpy as np

from stages.core import gcv, rbf

METHODS = ("rbf", "rbf_linear", "linear")
# of the single lambdas of `rbf_linear` round their common one
DECADE = 10.0


class Form(NamedTuple):
    """Hold what is settled before the weights are: the form of the function.

    Attributes
    ----------
    linear_dimensions, rbf_dimensions : int
        How many coordinates each part sees; 0 leaves the part out.
    factor : float
        Width over the median distance of an example from the nearest other one.
    share : float
        Of the Gaussian part beside the linear one, in `rbf_linear`: how much of the variance it
        may bring where the linear one brings one.
    common : float
        The lambda round which those of `rbf_linear` stay; 0 leaves them free.
    """

    linear_dimensions: int
    rbf_dimensions: int
    factor: float
    share: float = 0.0
    common: float = 0.0


class Regression(NamedTuple):
    """Hold a trained function.

    Attributes
    ----------
    constant : (K,) float array
    linear : (L, K) float array [1 / coordinate unit]
    centres : (N, C) float array [coordinate unit]
    weights : (N, K) float array
    width : float [coordinate unit]
    lambdas : (K,) float array
    """

    constant: np.ndarray
    linear: np.ndarray
    centres: np.ndarray
    weights: np.ndarray
    width: float
    lambdas: np.ndarray


def train(coordinates, targets, form):
    """Fit the function to examples, and predict each example from the others.

    A Gaussian part alone minimises ``sum_n |y_n - F(x_n)|^2 + lambda |w|^2`` (D06 equation 5), a
    linear one alone the same with its own coefficients, the constant free. Both together are
    penalised by the linear coefficients and by ``w'H w / share``, `H` the basis functions at the
    centres. Each lambda is found by generalised cross-validation.

    Parameters
    ----------
    coordinates : (N, C) float array
    targets : (N, K) float array
    form : Form

    Returns
    -------
    Regression
    (N, K) float array
        Residuals of leaving one out, the form and the lambdas as they are.

    Raises
    ------
    ValueError
        When the form sees more coordinates than there are.
    """
    coordinates, targets = np.asarray(coordinates, float), np.asarray(targets, float)
    most = max(form.linear_dimensions, form.rbf_dimensions)
    if most > coordinates.shape[1] or len(targets) != len(coordinates):
        shapes = f"examples {coordinates.shape}, weights {targets.shape}"
        raise ValueError(f"{shapes}: too few for {most} dimensions")
    centres = coordinates[:, : form.rbf_dimensions]
    width = form.factor * rbf.nearest_distance(centres) if form.rbf_dimensions else 1.0
    parts = decompose(coordinates, form)
    lambdas = gcv.choose(parts, targets)
    if form.common:
        lambdas = np.clip(lambdas, form.common / DECADE, form.common * DECADE)
    residuals = gcv.leave_one_out(parts, targets, lambdas)
    constant, weights = gcv.solve(parts, targets, lambdas)
    linear, gaussian = np.zeros((0, targets.shape[1])), np.zeros((0, targets.shape[1]))
    if form.linear_dimensions and form.rbf_dimensions:
        weights = gcv.dual(parts, weights)
        linear = coordinates[:, : form.linear_dimensions].T @ weights / _size(coordinates, form)
        gaussian = form.share * weights
        constant = np.mean(targets - _kernel(coordinates, form) @ weights, axis=0, keepdims=True)
    elif form.linear_dimensions:
        linear = weights / np.sqrt(_size(coordinates, form))
    else:
        gaussian, constant = weights, np.zeros((1, targets.shape[1]))
    return Regression(constant[0], linear, centres, gaussian, width, lambdas), residuals


def decompose(coordinates, form):
    """Return the decomposed design (`gcv.Design`) of a form at the examples."""
    one = np.ones((len(coordinates), 1))
    if form.linear_dimensions and form.rbf_dimensions:
        return gcv.decompose_kernel(_kernel(coordinates, form), one)
    if form.linear_dimensions:
        part = coordinates[:, : form.linear_dimensions]
        return gcv.decompose(part / np.sqrt(_size(coordinates, form)), one)
    return gcv.decompose(_basis(coordinates, form))


def predict(regression, coordinates):
    """Return the weights (T, K) at coordinates (T, C)."""
    coordinates = np.asarray(coordinates, float)
    found = regression.constant + coordinates[:, : len(regression.linear)] @ regression.linear
    if len(regression.weights):
        seen = coordinates[:, : regression.centres.shape[1]]
        found += rbf.basis(seen, regression.centres, regression.width) @ regression.weights
    return found


def _basis(coordinates, form):
    """Return the basis functions of every example at every example, (N, N)."""
    seen = coordinates[:, : form.rbf_dimensions]
    return rbf.basis(seen, seen, form.factor * rbf.nearest_distance(seen))


def _size(coordinates, form):
    """Return the mean squared length of what the linear part sees, so that shares have no unit."""
    seen = coordinates[:, : form.linear_dimensions]
    return np.mean(np.sum(seen**2, axis=1)) or 1.0


def _kernel(coordinates, form):
    """Return the kernel of both parts, (N, N)."""
    seen = coordinates[:, : form.linear_dimensions]
    linear = seen @ seen.T / _size(coordinates, form)
    return linear + form.share * _basis(coordinates, form)
