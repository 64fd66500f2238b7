"""Sounds made ready for comparing: every frequency that rises above the noise counts alike.

The cross-correlation of two sounds that are whitened so is their generalised cross-correlation
with phase transform (GCC-PHAT). Taken window by window, loud moments count no more than soft ones.
"""

import numpy as np

WINDOW_S = 0.256
BAND_HZ = (200.0, 3400.0)
# what does not rise above this multiple of this quantile of its frequency is noise or hum
FLOOR_QUANTILE, FLOOR_GAIN = 0.4, 1.5
# the floor is measured anew about this often
BLOCK_S = 30.0
# windows this far below the loudest are digital silence and say nothing about the noise
DEAD = 1e-5


def whiten(samples: np.ndarray, rate: int) -> np.ndarray:
    """Divide every window's spectrum by its magnitude, save where it does not rise above the noise.

    A bin of magnitude A over a floor F becomes `max(0, 1 - (F / A)^2)` times its phase. F is
    measured from the sound itself, so that steady hum and noise vanish however loud they are.

    Parameters
    ----------
    samples : (N,) float array
    rate : samples per second

    Returns
    -------
    (N,) float32 array; zero at the end, where no whole window is left
    """
    half = round(WINDOW_S * rate / 2)
    # no window reaches beyond the sound: one that does sees hum begin, which is a common event
    halves = samples[: len(samples) // half * half].reshape(-1, half).astype(np.float32)
    count = max(len(halves) - 1, 0)
    rise = np.sin(np.pi * np.arange(2 * half) / (2 * half)).astype(np.float32)
    whitened = np.zeros((-(-len(samples) // half), half), np.float32)
    blocks = max(1, round(count * half / (BLOCK_S * rate)))
    for block in range(blocks):
        first, last = count * block // blocks, count * (block + 1) // blocks
        windows = np.concatenate([halves[first:last], halves[first + 1 : last + 1]], axis=1)
        # loud hum leaks little through the steeper window
        spectra = np.fft.rfft(windows * rise**2, axis=1)
        spectra *= _gains(np.abs(spectra), np.fft.rfftfreq(2 * half, 1 / rate))
        windows = np.fft.irfft(spectra, axis=1) * rise
        whitened[first:last] += windows[:, :half]
        whitened[first + 1 : last + 1] += windows[:, half:]
    return whitened.ravel()[: len(samples)]


def _gains(magnitudes: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    """Return what every bin of (T, F) magnitudes is multiplied by."""
    inside = (frequencies >= BAND_HZ[0]) & (frequencies <= BAND_HZ[1])
    heard = magnitudes[:, inside]
    loudness = heard.max(axis=1, initial=0)
    live = loudness > DEAD * loudness.max(initial=0)
    gains = np.zeros_like(magnitudes)
    if live.any():
        floor = FLOOR_GAIN * np.quantile(heard[live], FLOOR_QUANTILE, axis=0).astype(np.float32)
        above = live[:, None] & (heard > floor)
        safe = np.where(above, heard, 1)
        gains[:, inside] = np.where(above, (1 - (floor / safe) ** 2) / safe, 0)
    return gains
