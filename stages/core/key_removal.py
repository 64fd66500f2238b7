"""Take keys out of curves one by one, the least one first, while watched vertices stay in place.

A key that cannot go is blocked: the frame and the vertex that would move too far are kept with it.
When it is asked again, after other keys went or vertices joined the watched, this one place is
looked at before all others, and most keys are blocked there still.
"""

import heapq

import numpy as np

from stages.core import keyed_curves


class Removal:
    """What of the curves' keys was tried, and what blocked it.

    Attributes
    ----------
    curves : the curves with their keys
    """

    def __init__(self, curves: keyed_curves.KeyedCurves, reach: np.ndarray) -> None:
        """Take curves with keys and how far each moves a vertex (K,)."""
        self.curves = curves
        self.reach = reach
        self.costs = np.zeros(curves.values.shape)
        # frame and place among the watched of what blocks a key; frame -1 where nothing is known
        self.frame = np.full(curves.values.shape, -1, np.int32)
        self.place = np.zeros(curves.values.shape, np.int16)

    def run(self, deltas: np.ndarray, tolerance: float) -> None:
        """Remove keys while no watched vertex moves farther than the tolerance.

        Parameters
        ----------
        deltas : (K, n, D) float array, the shapes at the watched vertices [unit]; those of an
            earlier run come first
        tolerance : the largest displacement [unit]
        """
        curves = self.curves
        moved = np.tensordot(curves.wrong.T, deltas, axes=1)
        moving = [np.flatnonzero(delta.any(axis=1)) for delta in deltas]
        strong = [delta[places] for delta, places in zip(deltas, moving, strict=True)]
        count, last = curves.values.shape[1], curves.values.shape[1] - 1
        queue = self._queue(moved, deltas, tolerance)
        while queue:
            cost, code = heapq.heappop(queue)
            channel, frame = divmod(code, count)
            if not curves.kept[channel, frame] or self.costs[channel, frame] != cost:
                continue
            low, high = int(curves.before[channel, frame]), int(curves.after[channel, frame])
            line, rows = curves.line(channel, low, high), slice(low + 1, high)
            watched = moving[channel]
            if len(watched):
                added = line - curves.wrong[channel, rows]
                ahead = moved[rows, watched] + added[:, None, None] * strong[channel]
                squares = np.einsum("tnd,tnd->tn", ahead, ahead)
                worst = int(squares.argmax())
                row, place = divmod(worst, len(watched))
                if squares[row, place] > tolerance**2:
                    self.frame[channel, frame] = low + 1 + row
                    self.place[channel, frame] = watched[place]
                    continue
                moved[rows, watched] = ahead
            curves.remove(channel, frame, low, high, line)
            for neighbour in (low, high):
                if 0 < neighbour < last:
                    heapq.heappush(queue, self._entry(channel, neighbour))

    def _queue(
        self, moved: np.ndarray, deltas: np.ndarray, tolerance: float
    ) -> list[tuple[float, int]]:
        """Return the heap of keys that nothing known blocks."""
        queue: list[tuple[float, int]] = []
        count = self.curves.values.shape[1]
        for channel in range(len(deltas)):
            keys, off = self.curves.inner(channel)
            costs = self.reach[channel] * off
            self.costs[channel, keys] = costs
            free = ~self._blocked(channel, keys, moved, deltas[channel], tolerance)
            codes = channel * count + keys[free]
            queue += zip(costs[free].tolist(), codes.tolist(), strict=True)
        heapq.heapify(queue)
        return queue

    def _blocked(
        self,
        channel: int,
        keys: np.ndarray,
        moved: np.ndarray,
        delta: np.ndarray,
        tolerance: float,
    ) -> np.ndarray:
        """Say which keys (N,) of a channel are blocked where they were blocked before."""
        curves = self.curves
        low, high = curves.before[channel, keys], curves.after[channel, keys]
        frame, place = self.frame[channel, keys], self.place[channel, keys]
        known = (low < frame) & (frame < high)
        blocked = np.zeros(len(keys), bool)
        low, high, frame, place = low[known], high[known], frame[known], place[known]
        added = curves.off(channel, frame, low, high) - curves.wrong[channel, frame]
        ahead = moved[frame, place] + added[:, None] * delta[place]
        blocked[known] = np.sum(ahead**2, axis=1) > tolerance**2
        return blocked

    def _entry(self, channel: int, frame: int) -> tuple[float, int]:
        """Return what removing a key would cost at most, and its place in the curves."""
        curves = self.curves
        low, high = int(curves.before[channel, frame]), int(curves.after[channel, frame])
        cost = float(self.reach[channel] * np.abs(curves.line(channel, low, high)).max())
        self.costs[channel, frame] = cost
        return cost, channel * curves.values.shape[1] + frame
