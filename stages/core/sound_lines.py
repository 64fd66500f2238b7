"""Lines on which chunks of two sounds agree: `lag = offset + drift * time`, and how well."""

from typing import NamedTuple

import numpy as np

from stages.core import sound_matching

GREATEST_DRIFT = 300e-6
# chunks that are sought everywhere; lines that are tried; chunks that try a line
SOUGHT, TRIED, TRYING = 16, 6, 40
# a rival is a line that is further off than this
APART_S = 0.25
NEAR_S = 1e-3
# chunks agree with a line that passes them within this
GRID_S = 0.25e-3
# parts of a chunk that follow a line each for itself
PARTS, TINY = 8, 1e-12
# a chunk is off the line where it matches this well elsewhere, and twice as well as on the line
SURE, OFF_GAIN = 10.0, 2.0
OFF_FROM_S, OFF_TO_S, OFF_SHARE = 0.01, 0.25, 0.15
# echoes hide the direct sound where another lag, this far off, is nearly as good
ECHO_FROM_S, ECHO_TO_S, ECHO_GAIN = 0.004, 0.1, 1.7


class Line(NamedTuple):
    """A line on the clock of the sound that was cut, and its score in standard deviations."""

    offset_s: float
    drift: float
    score: float

    def lag(self, time_s: np.ndarray) -> np.ndarray:
        """Return the lags at times [s]."""
        return self.offset_s + self.drift * time_s


class Lags(NamedTuple):
    """Chunks beside a line: (C,) arrays.

    time_s : time about which the chunk's energy lies [s], on the clock of the sound that was cut
    lag_s : lag of the greatest correlation on the line, between samples [s]
    score : its score
    score_off : the best score near the line, but not on it
    echoed : (2,) the greatest sum over all chunks on the line, and that a little off it
    """

    time_s: np.ndarray
    lag_s: np.ndarray
    score: np.ndarray
    score_off: np.ndarray
    echoed: np.ndarray


def best(sounds: sound_matching.Sounds) -> list[Line]:
    """Return lines that many chunks support, each far from the others, the best first."""
    sought = sound_matching.liveliest(sounds, SOUGHT)
    matches = sound_matching.search(sought)
    time = (sought.starts[matches.chunk] + sounds.length / 2) / sounds.rate
    lag = matches.lag / sounds.rate
    drifted = GREATEST_DRIFT * np.abs(time[:, None] - time)
    distance = np.abs(lag[:, None] - lag)
    agreeing = np.where(distance <= drifted + NEAR_S, matches.score**2, 0)
    support = sum(agreeing[:, matches.chunk == c].max(axis=1) for c in set(matches.chunk.tolist()))
    taken = []
    for match in np.argsort(-support, kind="stable"):
        if len(taken) < TRIED and np.all((distance > APART_S + drifted)[match, taken]):
            taken.append(match)
    trying = sound_matching.liveliest(sounds, TRYING)
    lines = [_through(trying, time[match], int(matches.lag[match])) for match in taken]
    return sorted(lines, key=lambda line: -line.score)


def _through(sounds: sound_matching.Sounds, time_s: float, lag: int) -> Line:
    """Return the line near a match that maximises the sum of all chunks' correlations.

    The score is `(sum_c r_c(lag + drift (t_c - t)) - p) / sqrt(sum_c var r_c)`, where p is what the
    best short piece gives: two vowels can be alike, but nothing around them is.
    """
    sounds = sounds._replace(starts=sounds.starts[sound_matching.overlapping(sounds, lag)])
    if not len(sounds.starts):
        return Line(lag / sounds.rate, 0.0, 0.0)
    away = (sounds.starts + sounds.length / 2) / sounds.rate - time_s
    steps = int(np.ceil(GREATEST_DRIFT * np.abs(away).max() / GRID_S))
    drifts = np.linspace(-GREATEST_DRIFT, GREATEST_DRIFT, 2 * steps + 1) if steps else np.zeros(1)
    near = int(np.ceil(NEAR_S * sounds.rate))
    total, variance = np.zeros((len(drifts), 2 * near + 1)), 0.0
    for start, seconds in zip(sounds.starts, away, strict=True):
        reach = int(np.ceil(GREATEST_DRIFT * abs(seconds) * sounds.rate)) + near
        correlation, part = sound_matching.around(sounds, int(start), lag, reach)
        first = reach - near + np.rint(drifts * seconds * sounds.rate).astype(int)
        total += correlation[first[:, None] + np.arange(2 * near + 1)]
        variance += part
    row, column = np.unravel_index(total.argmax(), total.shape)
    lags = lag + column - near + np.rint(drifts[row] * away * sounds.rate).astype(int)
    pieces = [
        sound_matching.pieces(sounds, *place)
        for place in zip(sounds.starts.tolist(), lags.tolist(), strict=True)
    ]
    kept = total[row, column] - np.concatenate(pieces).max()
    offset = (lag + column - near) / sounds.rate - drifts[row] * time_s
    return Line(float(offset), float(drifts[row]), float(kept / np.sqrt(variance)))


def follow(sounds: sound_matching.Sounds, line: Line) -> Lags:
    """Measure the lag of every chunk near a line; chunks that match nothing are left out."""
    near = int(np.ceil(NEAR_S * sounds.rate))
    inner, outer = round(OFF_FROM_S * sounds.rate), round(OFF_TO_S * sounds.rate)
    middles = (sounds.starts + sounds.length / 2) / sounds.rate
    lags = np.rint(line.lag(middles) * sounds.rate).astype(int)
    rows, profile = [], np.zeros(2 * outer + 1)
    for start in sounds.starts[sound_matching.overlapping(sounds, lags)].tolist():
        time, rounding, correlation, variance = _straightened(sounds, start, line, outer)
        profile += correlation
        place = outer - near + int(correlation[outer - near : outer + near + 1].argmax())
        if correlation[place] > 0 and variance > 0:
            off = max(correlation[: outer - inner].max(), correlation[outer + inner + 1 :].max())
            off_line = place - outer + _summit(correlation[place - 1 : place + 2]) - rounding
            scores = np.array([correlation[place], off]) / np.sqrt(variance)
            rows.append((time, line.lag(time) + off_line / sounds.rate, *scores))
    distance = np.abs(np.arange(-outer, outer + 1)) / sounds.rate
    echoes = (distance >= ECHO_FROM_S) & (distance <= ECHO_TO_S)
    echoed = np.array([profile[distance <= NEAR_S].max(), profile[echoes].max()])
    return Lags(*np.array(rows).reshape(-1, 4).T, echoed)


def _straightened(
    sounds: sound_matching.Sounds, start: int, line: Line, reach: int
) -> tuple[float, float, np.ndarray, float]:
    """Correlate the parts of a chunk each at the line's own lag, so that drift does not smear them.

    Returns
    -------
    time_s : time about which the parts that both sounds hold lie [s]
    rounding : what the line's lags are more than the whole samples used, in the mean [samples]
    correlation : (2 reach + 1,) float array, in the middle the line's lags
    variance : that of a correlation of unrelated sounds
    """
    parts = sounds._replace(length=sounds.length // PARTS)
    firsts = start + parts.length * np.arange(PARTS)
    times = (firsts + parts.length / 2) / sounds.rate
    lags = line.lag(times) * sounds.rate
    whole = np.rint(lags).astype(int)
    found = [
        sound_matching.around(parts, *place, reach)
        for place in zip(firsts.tolist(), whole.tolist(), strict=True)
    ]
    variances = np.array([variance for _, variance in found])
    share = variances / max(variances.sum(), TINY)
    correlation = np.sum([correlation for correlation, _ in found], axis=0)
    return float(share @ times), float(share @ (lags - whole)), correlation, variances.sum()


def _summit(values: np.ndarray) -> float:
    """Return where the parabola through three values is greatest, from the middle one [samples]."""
    bend = 2 * values[1] - values[0] - values[2]
    return float(np.clip((values[2] - values[0]) / (2 * bend), -0.5, 0.5)) if bend > 0 else 0.0


def broken(lags: Lags) -> bool:
    """Tell whether many chunks match elsewhere: sound was lost or repeated in one recording."""
    sure = np.maximum(lags.score, lags.score_off) > SURE
    off = sure & (lags.score_off > OFF_GAIN * lags.score)
    return bool(off.sum() > OFF_SHARE * sure.sum())


def blurred(lags: Lags) -> bool:
    """Tell whether an echo may be as loud as the direct sound, so that either could be it."""
    return bool(lags.echoed[0] < ECHO_GAIN * lags.echoed[1])
