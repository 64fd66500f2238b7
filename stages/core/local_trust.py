"""Two versions of curves in one: a calm one, and a keen one where it shows more than jitter.

The local Wiener filter of Lee 1980 on what the keen one has and the calm one has not: its mean
square near a frame, less that of jitter, is what moves there. Where the calm one is nearer to what
was measured, as it is without jitter, there is nothing to gain.
"""

import numpy as np

from stages.core import motion_events, multiresolution

# a mean square near a frame is this much above that of jitter before it counts
TRUST = 3.0
NEAR_S = 0.03


def blended(
    measured: np.ndarray, calm: np.ndarray, keen: np.ndarray, events: np.ndarray, rate: float
) -> np.ndarray:
    """Return the calm curves, and the keen ones in events and wherever something moves fast.

    Parameters
    ----------
    measured : (T, K) float array, finite
    calm, keen : (T, K) float arrays, what two filters make of it
    events : (T, K) float array in 0..1, how far a frame must be as in the keen curve
    rate : frames per second

    Returns
    -------
    (T, K) float array, between the two
    """
    apart = keen - calm
    least = TRUST * motion_events.noise(apart) ** 2
    near = multiresolution.smoothed(apart**2, max(1, round(NEAR_S * rate)))
    moves = near > least
    trusted = np.where(moves, 1.0 - least / np.where(moves, near, 1.0), 0.0)
    gains = np.sum((measured - keen) ** 2, axis=0) < np.sum((measured - calm) ** 2, axis=0)
    return calm + gains * np.maximum(events, trusted) * apart
