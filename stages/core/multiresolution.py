"""Multiresolution filtering of curves: bands of frequency with a gain each, without delay.

Bruderlin & Williams 1995, "Motion signal processing", section 2.1: a curve is smoothed again and
again by a kernel whose taps move apart by powers of two, `G_k+1 = w_k * G_k`, and
`G_K + sum_k g_k (G_k - G_k+1)` is the curve with the gains `g_k`. The kernels are symmetric, so
nothing is delayed, and not negative with sum one, so what is smoothed stays within its range.
"""

from collections.abc import Iterator

import numpy as np

TAPS = np.array([1.0, 4.0, 6.0, 4.0, 1.0]) / 16.0
# columns that are filtered at once: their curves stay in the processor's cache
COLUMNS = 32


def edges(rate: float, levels: int) -> np.ndarray:
    """Return the frequencies between the bands.

    `G_k` passes `(sin(2^k x) / (2^k sin x))^4` of a sinusoid with `x = pi f / rate`; a band ends
    where that is a half.

    Parameters
    ----------
    rate : frames per second
    levels : K, the number of bands

    Returns
    -------
    (K + 1,) float array [Hz], falling: band k lies between entries k + 1 and k; the first is half
    the rate
    """
    found = [rate / 2]
    for level in range(1, levels + 1):
        # up to where the response is zero first
        x = np.linspace(0.0, np.pi, 4097)[1:-1] / 2**level
        passed = (np.sin(2**level * x) / (2**level * np.sin(x))) ** 4
        found.append(np.interp(0.5, passed[::-1], x[::-1]) * rate / np.pi)
    return np.array(found)


def levels_above(rate: float, cutoff: float, count: int) -> int:
    """Return how many bands cover all that lies above a frequency, for curves of `count` frames."""
    most = max(count, 1).bit_length()
    below = np.flatnonzero(edges(rate, most) <= cutoff)
    return int(below[0]) if len(below) else most


def gains_below(rate: float, cutoff: np.ndarray, levels: int) -> np.ndarray:
    """Return gains that keep what lies below a frequency, whatever the rate.

    A band that the frequency divides keeps the share of its octaves that lies below.

    Parameters
    ----------
    rate : frames per second
    cutoff : (N,) float array, above zero [Hz]; infinite keeps all
    levels : K, the number of bands

    Returns
    -------
    (K, N) float array in 0..1
    """
    octave = np.log2(edges(rate, levels))[:, None]
    share = (np.log2(cutoff) - octave[1:]) / (octave[:-1] - octave[1:])
    return np.clip(share, 0.0, 1.0)


def smoothed(values: np.ndarray, step: int) -> np.ndarray:
    """Smooth the columns of a (T, N) array by the kernel with its taps `step` frames apart."""
    return _valid(values[_reflected(len(values), 2 * step)], step)


def bands(values: np.ndarray, levels: int) -> Iterator[np.ndarray]:
    """Split curves into the bands `G_k - G_k+1`, highest first, and at last `G_K`.

    Parameters
    ----------
    values : (T, N) float array, finite; reflected at its ends
    levels : K, the number of bands

    Yields
    ------
    K + 1 times a (T, N) float array; their sum is `values` to rounding
    """
    reach = 2 * (2**levels - 1)
    upper = values[_reflected(len(values), reach)]
    for level in range(levels):
        step = 2**level
        lower = _valid(upper, step)
        reach -= 2 * step
        inner = slice(reach, reach + len(values))
        yield upper[2 * step : -2 * step][inner] - lower[inner]
        upper = lower
    yield upper


def filtered(values: np.ndarray, gains: np.ndarray) -> np.ndarray:
    """Return `G_K + sum_k g_k (G_k - G_k+1)` of every column.

    Parameters
    ----------
    values : (T, N) float array, finite
    gains : (K, N) float array, of the bands from the highest down

    Returns
    -------
    (T, N) float array

    Raises
    ------
    ValueError
        if the shapes do not fit, or a value is not finite
    """
    if values.ndim != 2 or gains.ndim != 2 or values.shape[1] != gains.shape[1]:
        raise ValueError(f"values {values.shape} and gains {gains.shape} are no (T, N) and (K, N)")
    if not np.isfinite(values).all():
        raise ValueError(f"values {values.shape} are not all finite")
    made = np.empty(values.shape)
    for first in range(0, values.shape[1], COLUMNS):
        part = slice(first, first + COLUMNS)
        *high, rest = bands(np.ascontiguousarray(values[:, part]), len(gains))
        for band, gain in zip(high, gains[:, part], strict=True):
            rest = rest + gain * band
        made[:, part] = rest
    return made


def _reflected(count: int, reach: int) -> np.ndarray:
    """Return the rows of `count` that stand for those from -reach to count + reach."""
    period = max(2 * (count - 1), 1)
    rows = np.arange(-reach, count + reach) % period
    return np.minimum(rows, period - rows) if count > 1 else np.zeros_like(rows)


def _valid(values: np.ndarray, step: int) -> np.ndarray:
    """Smooth columns and drop the `2 step` rows at each end that lack a neighbour."""
    count = len(values) - 4 * step
    outer, inner, middle = (
        values[:count] + values[4 * step :],
        values[step : step + count] + values[3 * step : 3 * step + count],
        values[2 * step : 2 * step + count],
    )
    return TAPS[0] * outer + TAPS[1] * inner + TAPS[2] * middle
