"""Offset and drift between two recordings of one performance, from their sounds (D06 section 3).

GCC-PHAT of chunks of the shorter sound with the whole of the longer one gives lines, offset and
drift, on which many chunks agree. The best must stand well above chance and above the next best,
or the answer is a refusal. Then a robust line goes through the chunks' own lags.
"""

from typing import NamedTuple

import numpy as np

from stages.core import line_fit, sound_lines, sound_matching, spectral_whitening

SHORTEST_S = 1.0
# full scale is 1; 16-bit dither stays below
SILENT = 2e-4
# what unrelated speech reaches, in standard deviations
CHANCE = 6.0
LEAST_CONFIDENCE = 0.4
# a second line this strong, and this strong beside the best, is not chance
SECOND, SECOND_SHARE = 10.0, 0.1
# chunks that the line goes through; their lags are not trusted to be finer
FITTED, FINEST_S = 240, 5e-5
# the drift is told where the common sound is this long and the standard error no greater
DRIFT_SPAN_S, DRIFT_ERROR = 45.0, 5e-6
NOTHING = "no common sound found"


class Sync(NamedTuple):
    """`t_video = (1 + drift) * t_mocap + offset_s`, or a refusal.

    offset_s : offset [s]; NaN where refused
    drift : 1e-6 is a ppm; 0 where the common sound is too short to tell
    drift_error : its standard error; NaN where the drift is not told
    confidence : 0 to 1: how far the match stands above chance and above the next best
    reason : why it is refused; empty where it is not
    """

    offset_s: float
    drift: float
    drift_error: float
    confidence: float
    reason: str


def synchronise(mocap: np.ndarray, video: np.ndarray, rate: int) -> Sync:
    """Find where the mocap system's sound lies in the camera's.

    Parameters
    ----------
    mocap, video : (N,) and (M,) float arrays, 1 is full scale
    rate : samples per second of both

    Raises
    ------
    ValueError
        if a sound is not (N,), or the rate does not hold the band
    """
    if mocap.ndim != 1 or video.ndim != 1 or rate < 2 * spectral_whitening.BAND_HZ[1]:
        raise ValueError(f"expected sounds (N,), got {mocap.shape}, {video.shape} at {rate} Hz")
    if reason := _unusable("mocap", mocap, rate) or _unusable("camera", video, rate):
        return _refused(reason)
    swapped = len(mocap) > len(video)
    pair = (video, mocap) if swapped else (mocap, video)
    sounds = sound_matching.cut(*(spectral_whitening.whiten(one, rate) for one in pair), rate)
    lines = sound_lines.best(sounds) if len(sounds.starts) else []
    rival = max([line.score for line in lines[1:]], default=0.0)
    strength = max([line.score for line in lines], default=0.0)
    confidence = float(1 - max(rival, CHANCE) / max(strength, CHANCE))
    if rival > max(SECOND, SECOND_SHARE * strength):
        apart = abs(lines[0].offset_s - lines[1].offset_s)
        reason = f"chunks disagree: the sounds match at two places, {apart:.2f} s apart"
        return _refused(reason, confidence)
    if confidence < LEAST_CONFIDENCE:
        return _refused(NOTHING, confidence)
    lags = sound_lines.follow(sound_matching.liveliest(sounds, FITTED), lines[0])
    if sound_lines.broken(lags):
        return _refused("chunks disagree: sound is missing or repeated in one of them", confidence)
    if sound_lines.blurred(lags):
        return _refused("too much echo to tell the direct sound", confidence)
    return _fitted(lags, lines[0], swapped)._replace(confidence=confidence)


def _unusable(name: str, sound: np.ndarray, rate: int) -> str:
    """Say why a sound cannot be compared with another; nothing if it can."""
    if len(sound) < SHORTEST_S * rate:
        return f"the {name}'s sound is too short: {len(sound) / rate:.2f} s"
    return f"the {name}'s sound is silent" if np.ptp(sound) < 2 * SILENT else ""


def _refused(reason: str, confidence: float = 0.0) -> Sync:
    """Return a refusal."""
    return Sync(np.nan, 0.0, np.nan, confidence, reason)


def _fitted(lags: sound_lines.Lags, rough: sound_lines.Line, swapped: bool) -> Sync:
    """Return offset and drift of a robust line through the lags of single chunks.

    Lags are on the clock of the shorter sound; the line is on the mocap system's.
    """
    time, shift = lags.time_s, lags.lag_s
    offset, drift = rough.offset_s, rough.drift
    if swapped:
        time, shift = time + shift, -shift
        offset, drift = -offset / (1 + drift), 1 / (1 + drift) - 1
    weight = lags.score**2
    # what is left of the rough line is small, so that the robust scale starts small
    line = line_fit.robust(time, shift - offset - drift * time, weight, True, FINEST_S)
    if line.spread * np.sqrt(12) < DRIFT_SPAN_S or line.slope_error > DRIFT_ERROR:
        level = line_fit.robust(time, shift, weight, False, FINEST_S).level
        return Sync(level, 0.0, np.nan, 0.0, "")
    return Sync(offset + line.at(0.0), drift + line.slope, line.slope_error, 0.0, "")
