"""Which channels keep which moments of a take when it is smoothed.

A channel says so itself, or its name does: `eyeBlink_L`, `EyeBlinkLeft`, `blink_r` keep blinks,
what moves lips or jaw keeps lip closures. Every eye blinks for itself, lips close together.
"""

from collections.abc import Sequence

import numpy as np

from stages.core import motion_events

BLINK, CLOSURE = "blink", "closure"
MOVES_LIPS = ("mouth", "lip", "jaw")
SHOWS_CLOSURE = ("mouthclose", "jawopen")


def kinds(names: Sequence[str], keep: Sequence[str]) -> list[str]:
    """Return what every channel keeps, `blink`, `closure` or nothing: as asked, or by its name."""
    return [asked or _by_name(name) for name, asked in zip(names, keep, strict=True)]


def find(
    values: np.ndarray,
    names: Sequence[str],
    keep: Sequence[str],
    rate: float,
    gap: np.ndarray | None = None,
) -> np.ndarray:
    """Find the blinks and lip closures of a take.

    Lips meet and part as the distance of their points tells, else where the channels that ask for
    closures leave their level briefly, or if none asks, those named after jaw opening or mouth
    closing. If no channel moves lips by its name, what the points tell holds for all.

    Parameters
    ----------
    values : (T, N) float array, finite
    names : the N channels
    keep : N times `blink`, `closure` or nothing
    rate : frames per second
    gap : (T,) float array or None, distance of two points of the lips; NaN where not observed

    Returns
    -------
    (T, N) float array in 0..1, how far a frame belongs to an event of the channel
    """
    kept = np.array(kinds(names, keep), object)
    blinks, closing = kept == BLINK, kept == CLOSURE
    if gap is not None:
        closures = motion_events.closures(gap)
        closing = closing if closing.any() else ~blinks
    else:
        asked = np.array(keep, object) == CLOSURE
        named = np.array([any(part in _plain(name) for part in SHOWS_CLOSURE) for name in names])
        shown = asked if asked.any() else named & closing
        closures = motion_events.excursions(values[:, shown], rate).any(axis=1)
    made = np.zeros(values.shape)
    blinking = motion_events.excursions(values[:, blinks], rate)
    made[:, blinks] = motion_events.envelope(blinking, rate)
    made[:, closing] = motion_events.envelope(closures[:, None], rate)
    return made


def _by_name(name: str) -> str:
    """Return what a channel of such a name keeps."""
    plain = _plain(name)
    if BLINK in plain:
        return BLINK
    return CLOSURE if any(part in plain for part in MOVES_LIPS) else ""


def _plain(name: str) -> str:
    """Return the letters of a name in lower case."""
    return "".join(letter for letter in name.lower() if letter.isalpha())
