"""Where pieces of one whitened sound occur in another: correlations over lags.

Sample i of the one sound is sample i + lag of the other. A score is a correlation over its standard
deviation for unrelated sounds, so that pieces of any length and loudness compare.
"""

from typing import NamedTuple

import numpy as np

CHUNK_S = 4.0
OVERLAP_S = 0.5
PIECE_S = 0.25
CELL_S = 0.05
BEST_PER_CHUNK = 8
BLOCK = 1 << 17
# a place of the other sound that is quieter counts as if it had this share of the mean power
QUIET = 0.25


class Sounds(NamedTuple):
    """Two whitened sounds, of which the one is cut into chunks and sought in the other.

    one : (N,) float32 array
    other : (M,) float32 array
    starts : (C,) int array, first sample of every chunk of the one
    length : samples of a chunk
    rate : samples per second
    quiet : power that a place of the other has at least
    """

    one: np.ndarray
    other: np.ndarray
    starts: np.ndarray
    length: int
    rate: int
    quiet: float


class Matches(NamedTuple):
    """Places of the other sound that resemble chunks of the one: (M,) arrays."""

    chunk: np.ndarray
    lag: np.ndarray
    score: np.ndarray


def cut(one: np.ndarray, other: np.ndarray, rate: int) -> Sounds:
    """Cut the one sound into chunks of about `CHUNK_S`; where nothing is heard, there are none."""
    chunks = max(1, round(len(one) / (CHUNK_S * rate)))
    length = len(one) // chunks
    starts = np.arange(chunks) * length
    quiet = QUIET * _energy(other) / max(len(other), 1)
    sounding = [quiet > 0 and _energy(one[start : start + length]) > 0 for start in starts]
    return Sounds(one, other, starts[sounding], length, rate, quiet)


def liveliest(sounds: Sounds, count: int) -> Sounds:
    """Keep at most `count` chunks, spread over the sound, each the loudest of those around it."""
    loudness = np.array([_energy(sounds.one[s : s + sounds.length]) for s in sounds.starts])
    groups = np.array_split(np.arange(len(loudness)), min(count, len(loudness)))
    chosen = [group[loudness[group].argmax()] for group in groups]
    return sounds._replace(starts=sounds.starts[chosen])


def search(sounds: Sounds) -> Matches:
    """Find the best few lags of every chunk over all of the other sound, one in a cell at most."""
    cell = round(CELL_S * sounds.rate)
    whole = len(sounds.other) + 3 * sounds.length
    size = 1 << int(np.ceil(np.log2(min(max(BLOCK, 2 * sounds.length), whole))))
    step = (size - sounds.length) // cell * cell
    pieces = [sounds.one[start : start + sounds.length] for start in sounds.starts]
    spectra = [np.conj(np.fft.rfft(piece, size)) for piece in pieces]
    found = [[] for _ in pieces]
    for first in range(-sounds.length, len(sounds.other), step):
        block = _padded(sounds.other, first, size)
        spectrum = np.fft.rfft(block)
        inverse = 1 / np.sqrt(_running_power(block, sounds)[:step])
        for chunk, conjugate in enumerate(spectra):
            cells = (np.fft.irfft(spectrum * conjugate, size)[:step] * inverse).reshape(-1, cell)
            place = cells.argmax(axis=1)
            top = cells[np.arange(len(cells)), place]
            for row in np.argsort(-top, kind="stable")[:BEST_PER_CHUNK]:
                found[chunk].append((-top[row], first + row * cell + place[row]))
    rows = [
        (chunk, place - sounds.starts[chunk], -score / np.sqrt(_energy(pieces[chunk])))
        for chunk, places in enumerate(found)
        for score, place in sorted(places)[:BEST_PER_CHUNK]
    ]
    chunk, lag, score = zip(*rows, strict=True)
    return Matches(np.array(chunk), np.array(lag), np.array(score))


def _running_power(block: np.ndarray, sounds: Sounds) -> np.ndarray:
    """Return the mean power of a chunk's length from every sample on."""
    sums = np.concatenate([[0.0], np.cumsum(block.astype(float) ** 2)])
    power = (sums[sounds.length :] - sums[: -sounds.length]) / sounds.length
    return np.maximum(power, sounds.quiet).astype(np.float32)


def overlapping(sounds: Sounds, lags: np.ndarray) -> np.ndarray:
    """Return which chunks lie on the other sound for at least `OVERLAP_S`, each at its (C,) lag."""
    first = np.maximum(sounds.starts + lags, 0)
    last = np.minimum(sounds.starts + lags + sounds.length, len(sounds.other))
    return last - first >= OVERLAP_S * sounds.rate


def around(sounds: Sounds, start: int, lag: int, reach: int) -> tuple[np.ndarray, float]:
    """Correlate a chunk with the other sound near a lag.

    Parameters
    ----------
    sounds : the two sounds
    start : first sample of the chunk
    lag : lag in the middle [samples]
    reach : lags before and after it

    Returns
    -------
    correlation : (2 reach + 1,) float array
    variance : that of a correlation of unrelated sounds
    """
    piece = sounds.one[start : start + sounds.length]
    place = _padded(sounds.other, start + lag - reach, sounds.length + 2 * reach)
    size = 1 << int(np.ceil(np.log2(len(place))))
    spectrum = np.fft.rfft(place, size) * np.conj(np.fft.rfft(piece, size))
    correlation = np.fft.irfft(spectrum, size)[: 2 * reach + 1]
    first, last = np.clip([start + lag, start + lag + sounds.length], 0, len(sounds.other))
    energy = max(_energy(sounds.other[first:last]), sounds.quiet * int(last - first))
    return correlation, _energy(piece) * energy / sounds.length


def pieces(sounds: Sounds, start: int, lag: int) -> np.ndarray:
    """Return what short pieces of a chunk give to its correlation at a lag: it is their sum."""
    place = _padded(sounds.other, start + lag, sounds.length)
    product = sounds.one[start : start + sounds.length] * place
    return np.add.reduceat(product, np.arange(0, sounds.length, round(PIECE_S * sounds.rate)))


def _energy(samples: np.ndarray) -> float:
    """Return the sum of squares."""
    return float(np.dot(samples, samples))


def _padded(samples: np.ndarray, first: int, count: int) -> np.ndarray:
    """Return `count` samples from `first` on, zeros beyond both ends."""
    inside = samples[max(first, 0) : max(first + count, 0)]
    before = min(max(-first, 0), count)
    return np.pad(inside, (before, count - before - len(inside)))
