"""Frame rates and frames from times that were measured, rounded, or lack some frames."""

from fractions import Fraction

import numpy as np

STANDARD = (
    *(Fraction(rate) for rate in (24, 25, 30, 48, 50, 60, 90, 100, 120, 240)),
    *(Fraction(rate * 1000, 1001) for rate in (24, 30, 48, 60, 120, 240)),
)
SNAP = 0.005  # relative: clocks of devices differ by less, steps rounded to 1 ms average out
PLAUSIBLE = (5.0, 250.0)  # frames per second of films of faces
THOUSANDTHS = 1000  # other rates are rounded to these
# a step [s] of a film lies well below these, in milliseconds and in microseconds well above
UNITS = ((0.5, 1.0), (500.0, 1e-3), (np.inf, 1e-6))


def check_span(rows: int, frames: float) -> None:
    """Refuse rows that stand for so many frames that most would be invented.

    Raises
    ------
    ValueError
        stating both
    """
    if frames > 2 * rows + 1000:
        raise ValueError(f"{rows} rows stand for {frames:.6g} frames")


def seconds(times: np.ndarray) -> np.ndarray:
    """Return times in seconds that may be in milliseconds or microseconds, told by their steps.

    Parameters
    ----------
    times : (T,) float array, rising
    """
    if len(times) < 2:
        return times
    step = float(np.median(np.diff(times)))
    return times * next(unit for limit, unit in UNITS if step < limit)


def snapped(rate: float) -> Fraction:
    """Return the nearest standard rate, or the rate in thousandths if none is near."""
    nearest = min(STANDARD, key=lambda standard: abs(rate - standard))
    if abs(rate - nearest) <= SNAP * rate:
        return nearest
    return Fraction(round(rate * THOUSANDTHS), THOUSANDTHS)


def rate_of(time_s: np.ndarray, frame: np.ndarray | None = None) -> Fraction:
    """Infer frames per second from times, dropped frames or not.

    The median step is one frame; the rate is the number of such steps over the time that they
    take, so that rounded times average out, brought to the nearest standard rate.

    Parameters
    ----------
    time_s : (T,) float array [s]
    frame : (T,) int array, numbers of the frames if they are known

    Raises
    ------
    ValueError
        if the times do not rise, are too few, or give no plausible rate
    """
    if len(time_s) < 2:
        raise ValueError("one frame alone has no rate")
    steps = np.diff(time_s)
    if not (steps > 0).all():
        row = int(np.flatnonzero(~(steps > 0))[0]) + 1
        raise ValueError(f"time {time_s[row]:.6g} s follows {time_s[row - 1]:.6g} s")
    guess = np.maximum(np.rint(steps / np.median(steps)), 1)
    counts = guess if frame is None else np.diff(frame)
    whole = steps < 1.5 * np.median(steps / counts) * counts
    rate = float(counts[whole].sum() / steps[whole].sum())
    if not PLAUSIBLE[0] <= rate <= PLAUSIBLE[1]:
        raise ValueError(f"its times step by {1 / rate:.6g} s, which is no film's rate")
    return snapped(rate)


def numbers(time_s: np.ndarray, rate: Fraction) -> np.ndarray:
    """Return the (T,) frames of a constant rate nearest to times, the first at frame 0.

    Raises
    ------
    ValueError
        if two times fall on one frame
    """
    frame = np.rint((time_s - time_s[0]) * float(rate)).astype(np.int64)
    if (same := np.flatnonzero(np.diff(frame) < 1)).size:
        both = time_s[same[0] : same[0] + 2]
        raise ValueError(f"times {both[0]:.6g} s and {both[1]:.6g} s fall on one frame at {rate}/s")
    return frame
