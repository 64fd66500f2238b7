"""Close a character's lips while the actor's are closed: one more row of data for the layers.

Under the lips' mask the gap of a mix of extremes is at most ``sum_k u_lk gap_k``, linear in the
displacements; it is zero for whatever mix of extremes whose lips are closed, so that a smile with
closed lips stays a smile.
"""

import numpy as np

from stages.core import layer_model

WEIGHT = 1.0
SLACK = 0.02


def closing(
    model: layer_model.Model, quadratic: layer_model.Quadratic, near: float
) -> layer_model.Quadratic:
    """Add ``WEIGHT scale g / (1 - g) (sum_k u_lip,k gap_k)^2 / rms^2`` to a frame's data term.

    The ratio is that of the paper's eq. 7: at closeness one half an open lip costs as much as a
    mean extreme under a mask. `SLACK`, added to ``1 - g``, leaves lips that touch open by what
    nobody sees; else an emotion whose pose is open by a hair would have to go. As rank one the term
    leaves the data convex, so that bound and solver hold as they are.

    Parameters
    ----------
    model, quadratic : see `layer_model`
    near : float in 0..1, closeness g of the actor's lips
    """
    weight = WEIGHT * model.scale * near / (1.0 - near + SLACK)
    return quadratic._replace(gram=quadratic.gram + weight * np.outer(model.gap_row, model.gap_row))
