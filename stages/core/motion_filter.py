"""Take jitter out of weights and leave blinks and lip closures in, without delay.

The bands above a frequency are removed (`multiresolution`). In an event (`motion_events`) a band
keeps the part that is more than jitter there: `g = 1 - TRUST s^2 / m`, not below 0, with `s` the
band's jitter over the take and `m` its mean square near the frame (the local Wiener filter of Lee
1980, here by band). The gain between is `g_k + e (1 - g_k) g` with the event's envelope `e`.

Curves that are parts of a whole, as simplex weights are, share `e` and `g`, and `g` does not fall
towards lower bands. All that is done to them is then one mean with weights that are not negative
(`multiresolution`), so none falls below 0, and their sum nowhere exceeds what it was before.
"""

import numpy as np

from stages.core import motion_events, multiresolution

# a mean square near a frame is this much above that of jitter before it counts
TRUST = 1.5


def filtered(
    values: np.ndarray,
    rate: float,
    cutoff: np.ndarray,
    events: np.ndarray,
    whole: np.ndarray | None = None,
) -> np.ndarray:
    """Filter curves below a frequency of each, and leave events as they are.

    Parameters
    ----------
    values : (T, N) float array, finite
    rate : frames per second
    cutoff : (N,) float array, above zero [Hz]; a curve with an infinite one comes back unchanged
    events : (T, N) float array in 0..1, how far a frame belongs to an event of the curve
    whole : (N,) int array or None, of which whole each curve is a part; its curves need one cutoff

    Returns
    -------
    (T, N) float array

    Raises
    ------
    ValueError
        if the shapes do not fit, a value is not finite or a frequency is not above zero
    """
    if values.shape != events.shape or values.shape[1:] != cutoff.shape:
        shapes = f"values {values.shape}, cutoff {cutoff.shape} and events {events.shape}"
        raise ValueError(f"{shapes} are no (T, N), (N,) and (T, N)")
    if not (cutoff > 0).all():
        raise ValueError(f"cutoff {cutoff.min()} is not above zero")
    made = np.array(values, float)
    moved = np.isfinite(cutoff)
    if not moved.any():
        return made
    if whole is not None:
        events = _shared(events, whole)
    levels = multiresolution.levels_above(rate, cutoff[moved].min(), len(values))
    held = events.any(axis=0)
    for kept in (False, True):
        columns = np.flatnonzero(moved & (held == kept))
        for part in _parts(columns, whole):
            gains = multiresolution.gains_below(rate, cutoff[part], levels)
            curves = multiresolution.filtered(values[:, part], gains)
            if kept:
                curves += _of_events(values[:, part], gains, events[:, part], whole is not None)
            made[:, part] = curves
    return made


def _shared(events: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Give all parts of a whole the events (T, N) of each of them."""
    made = np.empty(events.shape)
    for number in np.unique(whole):
        part = whole == number
        made[:, part] = events[:, part].max(axis=1, keepdims=True)
    return made


def _parts(columns: np.ndarray, whole: np.ndarray | None) -> list[np.ndarray]:
    """Return the columns that are filtered at once: those of a whole, or as many as are fast."""
    if whole is None:
        size = multiresolution.COLUMNS
        return [columns[first : first + size] for first in range(0, len(columns), size)]
    return [columns[whole[columns] == number] for number in np.unique(whole[columns])]


def _of_events(
    values: np.ndarray, gains: np.ndarray, events: np.ndarray, together: bool
) -> np.ndarray:
    """Return what gains (K, N) take from curves (T, N) in their events (T, N) but for jitter."""
    made = np.zeros(values.shape)
    trusted = np.zeros((1, 1))
    high = list(multiresolution.bands(values, len(gains)))[:-1]
    for level, (band, gain) in enumerate(zip(high, gains, strict=True)):
        jitter = motion_events.noise(band) ** 2
        near = multiresolution.smoothed(band**2, 2**level)
        if together:
            jitter, near = jitter.sum(), near.sum(axis=1, keepdims=True)
        # an exact zero has nothing to keep
        found = np.clip(1.0 - TRUST * jitter / np.where(near > 0.0, near, 1.0), 0.0, 1.0)
        trusted = np.maximum(trusted, found) if together else found
        made += events * (1.0 - gain) * trusted * band
    return made
