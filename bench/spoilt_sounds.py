"""What happens to sound on a stage: noise, hum, rooms, other microphones, other clocks.

A way of spoiling is a word: `noise0` and `noise10` (white, decibels below the speech), `hum` (29
harmonics of 50 Hz, together ten times the speech), `room` (an exponential decay of 0.6 s as loud as
the direct sound), `hall` (6 dB louder than that), `filter` (nine bands, each up to 12 dB up or
down).
"""

import numpy as np
import scipy.signal

FINER = 8
DECAY_S = 0.6
FIRST_ECHO_S = 0.002


def spoil(sound, ways, rate, rng):
    """Return a sound (N,) spoilt in several ways; rooms first, noise last, whatever the order."""
    made = np.array(sound, dtype=float)
    for way, louder in (("room", 1.0), ("hall", 2.0)):
        if way in ways:
            made = scipy.signal.fftconvolve(made, _echoes(louder, rate, rng))[: len(made)]
    if "filter" in ways:
        gains = 10 ** (rng.uniform(-12, 12, 9) / 20)
        taps = scipy.signal.firwin2(257, np.linspace(0, 1, 9), gains)
        made = scipy.signal.fftconvolve(made, taps, "same")
    level = np.sqrt(np.mean(made**2))
    if "hum" in ways:
        hum = _hum(len(made), rate, rng)
        made += hum * (10 * level / np.sqrt(np.mean(hum**2)))
    for way, decibels in (("noise0", 0), ("noise10", 10)):
        if way in ways:
            made += rng.standard_normal(len(made)) * level * 10 ** (-decibels / 20)
    return made


def _echoes(louder, rate, rng):
    """Return the impulse response of a room: the direct sound, and noise that dies away."""
    count = round(DECAY_S * rate)
    echoes = rng.standard_normal(count) * 10 ** (-3 * np.arange(count) / count)
    echoes[: round(FIRST_ECHO_S * rate)] = 0
    echoes *= louder / np.sqrt(np.sum(echoes**2))
    echoes[0] = 1
    return echoes


def _hum(count, rate, rng):
    """Return mains hum."""
    time = np.arange(count) / rate
    hum = np.zeros(count)
    for harmonic in range(1, 30):
        hum += rng.uniform(0.3, 1) * np.sin(2 * np.pi * 50 * harmonic * time + rng.uniform(0, 7))
    return hum


def on_other_clock(sound, drift, offset_s, count, rate):
    """Return `count` samples of a recording that hears time t of a sound at `(1 + drift) t + o`."""
    finer = scipy.signal.resample_poly(sound, FINER, 1)
    time = (np.arange(count) / rate - offset_s) / (1 + drift)
    return np.interp(time * FINER * rate, np.arange(len(finer)), finer, left=0, right=0)


def plain_offset(mocap, video, rate):
    """Return the offset at which plain cross-correlation is greatest [s]."""
    signals = [sound - np.mean(sound) for sound in (video, mocap)]
    correlation = scipy.signal.correlate(*signals, "full", "fft")
    return (int(correlation.argmax()) - (len(mocap) - 1)) / rate
