"""Curves with keys, linear in between: what the lines are off by, and what a key prevents."""

import numpy as np


def error(curve: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Return lines between the keys of a curve (T,) less the curve (T,), 0 at the keys."""
    rows = np.flatnonzero(kept)
    line = np.interp(np.arange(len(curve)), rows, curve[rows])
    return np.where(kept, 0.0, line - curve)


class KeyedCurves:
    """Curves and their keys, channel by channel.

    Attributes
    ----------
    values : (K, T) float array, the curves
    kept : (K, T) bool array, the keys; the first and the last frame are always some
    wrong : (K, T) float array, lines between the keys less the curves
    before, after : (K, T) int array, at each key the ones next to it
    """

    def __init__(self, values: np.ndarray, kept: np.ndarray) -> None:
        """Take curves (T, K) and their keys (T, K)."""
        self.values = np.ascontiguousarray(values.T)
        self.kept = kept.T.copy()
        self.before = np.zeros(self.values.shape, np.int32)
        self.after = np.zeros(self.values.shape, np.int32)
        self.wrong = np.empty(self.values.shape)
        self.parts: dict[int, np.ndarray] = {}
        for channel, keys in enumerate(self.kept):
            rows = np.flatnonzero(keys)
            self.wrong[channel] = error(self.values[channel], keys)
            self.before[channel, rows[1:]] = rows[:-1]
            self.after[channel, rows[:-1]] = rows[1:]

    def line(self, channel: int, low: int, high: int) -> np.ndarray:
        """Return the line between two frames less the curve, at the frames inside."""
        length = high - low
        if length not in self.parts:
            self.parts[length] = np.arange(1, length) / length
        curve = self.values[channel, low : high + 1]
        return curve[0] + self.parts[length] * (curve[-1] - curve[0]) - curve[1:-1]

    def insert(self, channel: int, frame: int) -> tuple[int, int]:
        """Make a frame a key; return the keys next to it, between which the errors are others."""
        keys = self.kept[channel]
        if keys[frame]:
            return frame, frame
        low = frame - 1 - int(keys[frame - 1 :: -1].argmax())
        high = frame + 1 + int(keys[frame + 1 :].argmax())
        keys[frame] = True
        self.after[channel, low] = self.before[channel, high] = frame
        self.before[channel, frame], self.after[channel, frame] = low, high
        self.wrong[channel, low + 1 : frame] = self.line(channel, low, frame)
        self.wrong[channel, frame + 1 : high] = self.line(channel, frame, high)
        self.wrong[channel, frame] = 0.0
        return low, high

    def remove(self, channel: int, frame: int, low: int, high: int, line: np.ndarray) -> None:
        """Take the key between two others out; the line is that between these."""
        self.kept[channel, frame] = False
        self.wrong[channel, low + 1 : high] = line
        self.after[channel, low], self.before[channel, high] = high, low

    def inner(self, channel: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the keys (N,) between the outer two, and how far the line without each is off."""
        rows = np.flatnonzero(self.kept[channel])
        low, high = rows[:-2], rows[2:]
        if not len(low):
            return low, np.zeros(0)
        lengths = high - low - 1
        starts = np.cumsum(lengths) - lengths
        inside = np.arange(lengths.sum()) + np.repeat(low + 1 - starts, lengths)
        away = self.off(channel, inside, np.repeat(low, lengths), np.repeat(high, lengths))
        return rows[1:-1], np.maximum.reduceat(np.abs(away), starts)

    def off(
        self, channel: np.ndarray, frames: np.ndarray, low: np.ndarray, high: np.ndarray
    ) -> np.ndarray:
        """Return lines between pairs of frames less the curves, at one frame inside each (N,)."""
        first, last = self.values[channel, low], self.values[channel, high]
        part = (frames - low) / (high - low)
        return first + part * (last - first) - self.values[channel, frames]
