"""Choose the form of a regression by predicting each example from all the others."""

import numpy as np

from stages.core import gcv, rbf, weight_regression
from stages.core.weight_regression import Form

FACTORS = (1.0, 2.0, 4.0, 8.0)
DIMENSIONS = (2, 3, 4, 6, 8, 10, 12, 15, 20, 25, 30, 40)
MOST = DIMENSIONS[-1]
# what `rbf_linear` tries: its Gaussian part corrects the linear one, with a tenth of its variance
LINEAR_DIMENSIONS = (8, 15, 20, 25, 40)
RBF_DIMENSIONS = (4, 8, 15, 25)
SHARES = (1e-4, 1e-3, 1e-2, 1e-1)
COMMON = 10.0 ** np.arange(-4, 0.1, 0.5)
FEWEST = 3


def choose(coordinates, targets, method, dimensions=None, usual_width=False):
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
    usual_width : bool
        Take the root mean square distance of two examples for the width, not the best of `FACTORS`.
        The paper gives no sigma; this is a common choice.

    Returns
    -------
    Form

    Raises
    ------
    ValueError
        When the method is unknown, there are fewer than three examples, or fewer than dimensions.
    """
    coordinates = np.asarray(coordinates, float)
    count, most = coordinates.shape
    if method not in weight_regression.METHODS:
        raise ValueError(f"unknown method '{method}': {', '.join(weight_regression.METHODS)}")
    if count < FEWEST or (dimensions or 1) > min(count, most):
        wanted = f"{dimensions} dimensions" if dimensions else "a regression"
        message = f"{count} examples of {most} coordinates are too few for {wanted}"
        raise ValueError(message)
    tried = (dimensions,) if dimensions else _within(DIMENSIONS, min(count - 2, most))
    gaussian = tried
    if method == "rbf_linear" and not dimensions:
        tried, gaussian = (_within(part, tried[-1]) for part in (LINEAR_DIMENSIONS, RBF_DIMENSIONS))
    widths = [(each, factor) for each in gaussian for factor in FACTORS]
    if usual_width:
        widths = [(each, rbf.usual_factor(coordinates[:, :each])) for each in gaussian]
    if method == "rbf_linear":
        return _choose_both(coordinates, targets, tried, widths)
    if method == "linear":
        forms = [Form(each, 0, 1.0) for each in tried]
    else:
        forms = [Form(0, *each) for each in widths]
    scores = [_own_score(coordinates, targets, form) for form in forms]
    return forms[int(np.argmin(scores))]


def _within(numbers, most):
    """Return the numbers below a limit, and the limit or the last of them."""
    most = max(most, 1)
    return (*(number for number in numbers if number < most), min(most, numbers[-1]))


def _own_score(coordinates, targets, form):
    """Return the mean squared residual with a lambda of its own for each target."""
    parts = weight_regression.decompose(coordinates, form)
    residuals = gcv.leave_one_out(parts, targets, gcv.choose(parts, targets))
    return np.mean(residuals**2)


def _choose_both(coordinates, targets, linear, widths):
    """Choose the form of `rbf_linear`, with its common lambda."""
    # residuals of shared lambdas turn with the targets: as many columns as examples are enough
    left, singular, _ = np.linalg.svd(targets, full_matrices=False)
    reduced = left * singular
    best, lowest = None, np.inf
    for form in [
        Form(first, *second, share) for first in linear for second in widths for share in SHARES
    ]:
        parts = weight_regression.decompose(coordinates, form)
        for common in COMMON:
            residuals = gcv.leave_one_out(parts, reduced, np.array([common]))
            score = np.sum(residuals**2)
            if score < lowest:
                best, lowest = form._replace(common=common), score
    return best
