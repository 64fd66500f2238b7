"""Synthesise a voice for the phones that the mouth forms: pulses through resonances."""

import numpy as np
from scipy import signal

from data_example.generator import speech

RATE = 48000


def _resonator(frequency, bandwidth):
    """Return a second-order section that rings at a frequency [Hz]."""
    r = np.exp(-np.pi * bandwidth / RATE)
    c = 2 * r * np.cos(2 * np.pi * frequency / RATE)
    return np.array([1 - c + r * r]), np.array([1, -c, r * r])


def _voiced(source, resonances):
    """Return a source filtered by three resonances in a row."""
    out = source
    for frequency, bandwidth in zip(resonances, (75, 100, 160), strict=True):
        b, a = _resonator(frequency, bandwidth)
        out = signal.lfilter(b, a, out)
    return out


def _pulses(pitch, rng):
    """Return a train of rounded glottal pulses with slight jitter."""
    phase = np.cumsum(pitch * (1 + 0.006 * rng.standard_normal(len(pitch))) / RATE) % 1
    pulse = np.where(phase < 0.6, np.sin(np.pi * phase / 0.6) ** 2, 0.0)
    return np.diff(pulse, prepend=0)


def voice(phones, duration_s, seed=11):
    """Synthesise the sound of a schedule of phones.

    Parameters
    ----------
    phones : list of (name, start, end) [s]
    duration_s : float
    seed : int

    Returns
    -------
    samples : (S,) float32 array in -1..1, at RATE
    """
    rng = np.random.default_rng(seed)
    count = round(duration_s * RATE)
    t = np.arange(count) / RATE
    melody = 196 + 22 * np.sin(2 * np.pi * 0.37 * t) + 11 * np.sin(2 * np.pi * 1.3 * t + 1)
    source = _pulses(melody, rng)
    hiss = signal.lfilter(*signal.butter(2, 3500 / (RATE / 2), "high"), rng.standard_normal(count))
    out = np.zeros(count)
    for name, start, end in phones:
        first, last = max(round((start - 0.05) * RATE), 0), min(round((end + 0.05) * RATE), count)
        edge = np.clip(np.minimum(t[first:last] - start, end - t[first:last]) / 0.05 + 0.5, 0, 1)
        edge = edge * edge * (3 - 2 * edge)
        if name in speech.VOICE:
            *resonances, loud = speech.VOICE[name]
            out[first:last] += loud * edge * _voiced(source[first:last], resonances)
        if name in speech.HISS:
            out[first:last] += 0.06 * speech.HISS[name] * edge * hiss[first:last]
    out /= max(np.abs(out).max(), 1e-9) / 0.6
    out += 4e-4 * rng.standard_normal(count)
    return out.astype(np.float32)


def room(duration_s, seed):
    """Return quiet room noise, (S,) float32 at RATE."""
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal(round(duration_s * RATE))
    return (0.004 * signal.lfilter([0.05], [1, -0.95], noise)).astype(np.float32)
