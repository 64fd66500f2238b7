"""Take keys out of curves one by one, the least one first, while watched vertices stay in place."""

import heapq

import numpy as np


def error(curve: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Return lines between the keys of a curve (T,) less the curve (T,), 0 at the keys."""
    rows = np.flatnonzero(kept)
    line = np.interp(np.arange(len(curve)), rows, curve[rows])
    return np.where(kept, 0.0, line - curve)


class Removal:
    """Curves with keys, and the displacement of the watched vertices that their errors make.

    Attributes
    ----------
    kept : (T, K) bool array, the keys
    wrong : (T, K) float array, lines between the keys less the curves
    """

    def __init__(self, values: np.ndarray, kept: np.ndarray, reach: np.ndarray) -> None:
        """Take curves (T, K), their keys (T, K) and how far each moves a vertex (K,)."""
        self.kept = kept.copy()
        self.values = values
        self.reach = reach
        self.before = np.zeros(values.shape, int)
        self.after = np.zeros(values.shape, int)
        self.wrong = np.zeros(values.shape)
        for channel in range(values.shape[1]):
            self._rebuild(channel)

    def _rebuild(self, channel: int) -> None:
        """Find neighbours and errors of a channel from its keys."""
        rows = np.flatnonzero(self.kept[:, channel])
        self.wrong[:, channel] = error(self.values[:, channel], self.kept[:, channel])
        self.before[rows[1:], channel] = rows[:-1]
        self.after[rows[:-1], channel] = rows[1:]

    def insert(self, channel: int, frame: int) -> None:
        """Make a frame a key again."""
        self.kept[frame, channel] = True
        self._rebuild(channel)

    def run(self, deltas: np.ndarray, tolerance: float) -> None:
        """Remove keys while no watched vertex moves farther than the tolerance.

        Parameters
        ----------
        deltas : (K, n, D) float array, the shapes at the watched vertices [unit]
        tolerance : the largest displacement [unit]
        """
        moving = [np.flatnonzero(delta.any(axis=1)) for delta in deltas]
        moved = np.tensordot(self.wrong, deltas, axes=1)
        queue = []
        inner = self.kept.copy()
        inner[[0, -1]] = False
        for frame, channel in zip(*np.nonzero(inner), strict=True):
            queue.append(self._entry(int(frame), int(channel)))
        heapq.heapify(queue)
        while queue:
            _, frame, channel, low, high = heapq.heappop(queue)
            if not self._current(frame, channel, low, high):
                continue
            added = self._line(channel, low, high) - self.wrong[low + 1 : high, channel]
            watched = moving[channel]
            if len(watched):
                rows = slice(low + 1, high)
                ahead = moved[rows, watched] + added[:, None, None] * deltas[channel, watched]
                if np.einsum("tnd,tnd->tn", ahead, ahead).max() > tolerance**2:
                    continue
                moved[rows, watched] = ahead
            self.wrong[low + 1 : high, channel] += added
            self.kept[frame, channel] = False
            self.after[low, channel], self.before[high, channel] = high, low
            for neighbour in (low, high):
                if 0 < neighbour < len(self.values) - 1:
                    heapq.heappush(queue, self._entry(neighbour, channel))

    def _current(self, frame: int, channel: int, low: int, high: int) -> bool:
        """Say whether a key still stands between the same two."""
        if not self.kept[frame, channel]:
            return False
        return self.before[frame, channel] == low and self.after[frame, channel] == high

    def _entry(self, frame: int, channel: int) -> tuple[float, int, int, int, int]:
        """Return what removing a key would cost at most, the key and its neighbours."""
        low, high = int(self.before[frame, channel]), int(self.after[frame, channel])
        cost = self.reach[channel] * np.abs(self._line(channel, low, high)).max()
        return float(cost), frame, channel, low, high

    def _line(self, channel: int, low: int, high: int) -> np.ndarray:
        """Return the line between two keys less the curve, at the frames inside."""
        curve = self.values[low : high + 1, channel]
        part = np.arange(1, high - low) / (high - low)
        return curve[0] + part * (curve[-1] - curve[0]) - curve[1:-1]
