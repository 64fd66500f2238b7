"""Timecodes `HH:MM:SS:FF`, and `HH:MM:SS;FF` with dropped numbers (SMPTE ST 12-1).

At 30000/1001 frames per second thirty numbers a second run behind the clock: drop-frame timecode
leaves out the first two numbers of every minute but each tenth (at 60000/1001 the first four).
"""

import re
from fractions import Fraction

FORM = re.compile(r"^(\d{1,2}):(\d{2}):(\d{2})([:;.])(\d{2,3})$")
# numbers that are dropped in a minute, by the rate
DROPPED = {Fraction(30000, 1001): 2, Fraction(60000, 1001): 4}


def numbers_per_second(rate: Fraction) -> int:
    """Return how many numbers a second of timecode has: the rate, rounded up."""
    return -(-rate.numerator // rate.denominator)


def parse(text: str, rate: Fraction) -> int:
    """Return the frames from midnight to a timecode.

    Parameters
    ----------
    text : `HH:MM:SS:FF`; a semicolon or a point before the frames means drop-frame
    rate : frames per second

    Raises
    ------
    ValueError
        if the text is no timecode, or one that the rate does not have
    """
    found = FORM.match(text)
    if not found:
        raise ValueError(f"'{text}' is no timecode HH:MM:SS:FF")
    hours, minutes, seconds, frames = (int(found[part]) for part in (1, 2, 3, 5))
    base, drops = numbers_per_second(rate), found[4] != ":"
    if hours > 23 or minutes > 59 or seconds > 59 or frames >= base:
        raise ValueError(f"'{text}' is beyond 23:59:59:{base - 1}")
    count = (hours * 3600 + minutes * 60 + seconds) * base + frames
    if not drops:
        return count
    dropped = _dropped(rate)
    whole = hours * 60 + minutes
    if seconds == 0 and frames < dropped and minutes % 10:
        raise ValueError(f"'{text}' is one of the numbers that drop-frame leaves out")
    return count - dropped * (whole - whole // 10)


def write(count: int, rate: Fraction, drops: bool) -> str:
    """Return the timecode of a frame, counted from midnight; after a day it begins anew.

    Parameters
    ----------
    count : frames from midnight
    rate : frames per second
    drops : whether numbers are dropped

    Raises
    ------
    ValueError
        if the rate has no drop-frame timecode
    """
    base = numbers_per_second(rate)
    if drops:
        dropped = _dropped(rate)
        minute, ten = 60 * base - dropped, 600 * base - 9 * dropped
        tens, rest = divmod(count % (144 * ten), ten)
        # the first minute of ten drops nothing
        later = max(0, (rest - dropped) // minute)
        count = tens * 600 * base + rest + dropped * later
    seconds, frames = divmod(count % (86400 * base), base)
    minutes, seconds = divmod(seconds, 60)
    mark = ";" if drops else ":"
    return f"{minutes // 60:02d}:{minutes % 60:02d}:{seconds:02d}{mark}{frames:02d}"


def _dropped(rate: Fraction) -> int:
    """Return how many numbers a minute leaves out."""
    if rate not in DROPPED:
        raise ValueError(f"drop-frame timecode exists at 29.97 and 59.94 frames/s, not at {rate}")
    return DROPPED[rate]
