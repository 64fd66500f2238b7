"""Takes as Live Link Face writes them: timecode, count, 52 curves, nine angles.

The timecode `HH:MM:SS:FF.mmm` counts sixtieths of a second and their thousandths, whatever the
rate. Curves stand in Live Link Face's order, the jaw and the mouth to the right before the left.
Angles are radians as the phone has them: yaw positive to the subject's right, pitch downwards, roll
mirrored like yaw; the head turns by roll first, then pitch, then yaw. Eyes stay at 0.
"""

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import numpy as np

HEAD = ("HeadYaw", "HeadPitch", "HeadRoll")
EYES = ("LeftEyeYaw", "LeftEyePitch", "LeftEyeRoll", "RightEyeYaw", "RightEyePitch", "RightEyeRoll")
MIRRORED = np.array([-1.0, 1.0, -1.0])
# in a second: thousandths of sixtieths
TICKS = 60_000
DAY_S = 86_400


def timecode(time_s: Fraction) -> str:
    """Return the timecode of a time from midnight [s]; after a day it begins anew."""
    seconds, part = divmod(round(time_s * TICKS) % (DAY_S * TICKS), TICKS)
    minutes, seconds = divmod(seconds, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours:02d}:{minutes:02d}:{seconds:02d}:{part // 1000:02d}.{part % 1000:03d}"


def write(
    path: str | Path,
    names: Sequence[str],
    times_s: Sequence[Fraction],
    curves: np.ndarray,
    head: np.ndarray,
) -> None:
    """Write a take.

    Parameters
    ----------
    path : the file
    names : the curves as Live Link Face spells them, in its order
    times_s : T times from midnight [s]
    curves : (T, 52) float array
    head : (T, 3) float array, turns about the face's y, x and z [rad]
    """
    header = ["Timecode", "BlendShapeCount", *names, *HEAD, *EYES]
    still = np.zeros((len(curves), len(EYES)))
    # the sum makes a plain zero of a negative one
    rows = np.concatenate([curves, head * MIRRORED, still], axis=1) + 0.0
    count = str(rows.shape[1])
    with Path(path).open("w", encoding="utf-8", newline="\n") as stream:
        stream.write(",".join(header) + "\n")
        for time_s, row in zip(times_s, rows, strict=True):
            cells = [timecode(time_s), count, *(f"{value:.10f}" for value in row)]
            stream.write(",".join(cells) + "\n")
