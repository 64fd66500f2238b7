"""Choose the form of a regression by predicting each example from all the others."""

import numpy as np

from stages.core import gcv, weight_regression
from stages.core.weight_regression import Form

PUBLISHED_DIMENSIONS = 4
# the paper gives no sigma: twice the usual distance of neighbours lets them overlap
PUBLISHED_FACTOR = 2.0
FACTORS = (1.0, 2.0, 4.0, 8.0)
DIMENSIONS = (2, 3, 4, 6, 8, 10, 12, 15, 20, 25, 30, 40)
MOST = DIMENSIONS[-1]
# what `rbf_linear` tries: coordinates of its Gaussian part, shares of it, common lambdas
RBF_DIMENSIONS = (4, 8, 15, 25)
LINEAR_DIMENSIONS = (8, 15, 20, 25, 40)
SHARES = 10.0 ** np.arange(-4, 3.1)
COMMON = 10.0 ** np.arange(-5, 3.1, 0.5)
FEWEST = 3


def choose(coordinates, targets, method, dimensions=None, factor=None):
    """Choose the form of least mean squared residual of leaving one example out.

    For `rbf` and `linear` every candidate has its own lambdas, by generalised cross-validation.
    For `rbf_linear` all weights share one lambda while its form is chosen, and that lambda is part
    of the form: with a hundred examples, generalised cross-validation of single weights is too
    noisy to tell so many forms apart.

    Parameters
    ----------
    coordinates : (N, C) float array
    targets : (N, K) float array
    method : str
        One of `weight_regression.METHODS`.
    dimensions : int, optional
        Coordinates that every part sees; chosen when not given.
    factor : float, optional
        Width over the examples' usual distance; chosen when not given.

    Returns
    -------
    Form

    Raises
    ------
    ValueError
        When the method is unknown, there are fewer than three examples, or fewer than dimensions.
    """
    count, most = np.shape(coordinates)
    if method not in weight_regression.METHODS:
        raise ValueError(f"unknown method '{method}': {', '.join(weight_regression.METHODS)}")
    if count < FEWEST or (dimensions or 1) > min(count, most):
        wanted = f"{dimensions} dimensions" if dimensions else "a regression"
        message = f"{count} examples of {most} coordinates are too few for {wanted}"
        raise ValueError(message)
    tried = (dimensions,) if dimensions else _within(DIMENSIONS, min(count - 2, most))
    factors = (factor,) if factor else FACTORS
    if method == "rbf_linear":
        return _choose_both(coordinates, targets, tried, dimensions, factors)
    if method == "linear":
        forms = [Form(each, 0, 1.0) for each in tried]
    else:
        forms = [Form(0, each, width) for each in tried for width in factors]
    scores = [_own_score(coordinates, targets, form) for form in forms]
    return forms[int(np.argmin(scores))]


def _within(numbers, most):
    """Return the numbers up to a limit, or the limit alone."""
    return tuple(number for number in numbers if number <= most) or (max(most, 1),)


def _own_score(coordinates, targets, form):
    """Return the mean squared residual with a lambda of its own for each target."""
    parts = weight_regression.decompose(coordinates, form)
    residuals = gcv.leave_one_out(parts, targets, gcv.choose(parts, targets))
    return np.mean(residuals**2)


def _choose_both(coordinates, targets, tried, dimensions, factors):
    """Choose the form of `rbf_linear`, with its common lambda."""
    # residuals of shared lambdas turn with the targets: as many columns as examples are enough
    left, singular, _ = np.linalg.svd(targets, full_matrices=False)
    reduced = left * singular
    most = tried[-1]
    linear = tried if dimensions else _within(LINEAR_DIMENSIONS, most)
    gaussian = tried if dimensions else _within(RBF_DIMENSIONS, most)
    best, lowest = None, np.inf
    for form in [
        Form(first, second, factor, share)
        for first in linear
        for second in gaussian
        for factor in factors
        for share in SHARES
    ]:
        parts = weight_regression.decompose(coordinates, form)
        for common in COMMON:
            residuals = gcv.leave_one_out(parts, reduced, np.array([common]))
            score = np.sum(residuals**2)
            if score < lowest:
                best, lowest = form._replace(common=common), score
    return best
