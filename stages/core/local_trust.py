"""Two versions of curves in one: a calm one, and a keen one where it shows more than jitter.

The local Wiener filter of Lee 1980 on what the keen one has and the calm one has not: its mean
square near a frame, less that of jitter, is what moves there.
"""

import numpy as np

from stages.core import motion_events, multiresolution

# a mean square near a frame is this much above that of jitter before it counts
TRUST = 3.0
NEAR_S = 0.03


def blended(calm: np.ndarray, keen: np.ndarray, events: np.ndarray, rate: float) -> np.ndarray:
    """Return the calm curves, and the keen ones in events and wherever something moves fast.

    Parameters
    ----------
    calm, keen : (T, K) float arrays, finite
    events : (T, K) float array in 0..1, how far a frame must be as in the keen curve
    rate : frames per second

    Returns
    -------
    (T, K) float array, between the two
    """
    apart = keen - calm
    jitter = motion_events.noise(apart) ** 2
    near = multiresolution.smoothed(apart**2, max(1, round(NEAR_S * rate)))
    trusted = np.clip(1.0 - TRUST * jitter / np.where(near > 0.0, near, 1.0), 0.0, 1.0)
    return calm + np.maximum(events, trusted) * apart
