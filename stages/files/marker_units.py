"""Unit, axes and rate of a marker file, as the file and the show state them."""

import math
import re
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.files import errors, marker_take

FROM_FILE = "file"
MILLIMETRES = {
    "mm": 1.0, "millimeter": 1.0, "millimeters": 1.0, "millimetre": 1.0, "millimetres": 1.0,
    "cm": 10.0, "centimeter": 10.0, "centimeters": 10.0, "centimetre": 10.0, "centimetres": 10.0,
    "m": 1000.0, "meter": 1000.0, "meters": 1000.0, "metre": 1000.0, "metres": 1000.0,
    "in": 25.4, "inch": 25.4, "inches": 25.4,
}  # fmt: skip
UNITS = ("mm", "cm", "m", "inch")
BY_TIMES = "its times"
SAME_RATE, SAME_RATE_AT_MOST = 1e-4, 0.01
HALF_A_FRAME = 0.5


def millimetres(path: str | Path, wanted: str, stated: str) -> float:
    """Return how many millimetres a unit of the file has.

    Parameters
    ----------
    path : the file, for the error
    wanted : `file`, a unit, or a number of millimetres
    stated : the unit that the file states; blank if none

    Raises
    ------
    errors.InputError
        if neither gives a unit
    """
    if wanted != FROM_FILE:
        factor = MILLIMETRES.get(wanted.lower()) or _number(wanted)
        if not factor:
            message = f"'{wanted}' is no unit: write file, {', '.join(UNITS)}, or a number of mm"
            raise errors.InputError("--unit", message)
        return factor
    if stated.strip().lower() not in MILLIMETRES:
        what = f"states the unit '{stated}', which is unknown" if stated else "states no unit"
        cure = f"write {', '.join(UNITS)}, or the mm of one unit, into marker_unit in sessions.tsv"
        raise errors.InputError(path, f"{what}: {cure}")
    return MILLIMETRES[stated.strip().lower()]


def _number(text: str) -> float:
    """Return a positive number, or 0."""
    try:
        value = float(text)
    except ValueError:
        return 0.0
    return value if 0 < value < math.inf else 0.0


def axes(text: str) -> np.ndarray:
    """Return the rows that take the file's axes to left, up and out of the face.

    Parameters
    ----------
    text : three signed letters, such as `x z -y`

    Returns
    -------
    (3, 3) float array; a reflection where the file's axes are left-handed

    Raises
    ------
    errors.InputError
        if they are not three different axes
    """
    words = re.findall(r"[+-]?[xyz]", text.lower())
    letters = [word[-1] for word in words]
    if sorted(letters) != ["x", "y", "z"] or "".join(words) != re.sub(r"[\s,]", "", text.lower()):
        message = f"'{text}' are not three axes: write the file's axes that point to the subject's"
        raise errors.InputError("--axes", message + " left, up and out of the face, as x z -y")
    rows = np.zeros((3, 3))
    for row, word in enumerate(words):
        rows[row, "xyz".index(word[-1])] = -1.0 if word[0] == "-" else 1.0
    return rows


def rate(path: str | Path, take: marker_take.MarkerTake, wanted: str) -> Fraction:
    """Return the rate of a take.

    Parameters
    ----------
    path : the file, for the error
    take : the take, with what its file states
    wanted : frames per second; blank takes the file's

    Raises
    ------
    errors.InputError
        if there is none, or if two of them contradict each other
    """
    slack = min(max(SAME_RATE, HALF_A_FRAME / len(take.points)), SAME_RATE_AT_MOST)
    stated = dict(take.rates)
    if wanted:
        given = _given(wanted)
        judges = {k: v for k, v in stated.items() if k == BY_TIMES} or stated
        if judges and not any(abs(float(given) / value - 1) <= slack for value in judges.values()):
            message = (
                f"is of {_listed(judges)}, not of {wanted} Hz: clear source_rate in sessions.tsv"
            )
            raise errors.InputError(path, message)
        return given
    if not stated:
        raise errors.InputError(
            path, "states no rate and no times: give source_rate in sessions.tsv"
        )
    first = next(iter(stated.values()))
    if any(abs(value / first - 1) > slack for value in stated.values()):
        message = (
            f"contradicts itself, {_listed(stated)}: give the true source_rate in sessions.tsv"
        )
        raise errors.InputError(path, message)
    return rational(first, slack if BY_TIMES in stated and len(stated) == 1 else SAME_RATE)


def _given(text: str) -> Fraction:
    """Return a rate as a person writes it."""
    try:
        given = Fraction(text)
    except (ValueError, ZeroDivisionError):
        given = Fraction(0)
    if given <= 0:
        raise errors.InputError("--rate", f"'{text}' is no rate such as 120 or 120000/1001")
    return given


def _listed(stated: dict[str, float]) -> str:
    """Return rates and where they stand, for a message."""
    return ", ".join(f"{value:.6g} Hz by {place}" for place, value in stated.items())


def rational(value: float, slack: float = SAME_RATE) -> Fraction:
    """Return the whole or NTSC rate that is meant, or the nearest fraction."""
    whole = Fraction(round(value))
    broadcast = Fraction(round(value * 1001 / 1000) * 1000, 1001)
    nearest = min((whole, broadcast), key=lambda known: abs(float(known) - value))
    if nearest > 0 and abs(float(nearest) / value - 1) <= slack:
        return nearest
    return Fraction(value).limit_denominator(1000)
