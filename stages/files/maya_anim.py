"""Maya's `.anim` 1.1: a text of animation curves, one for each target of a blendShape node.

After Autodesk's description of the format. `timeUnit` is the word for the rate; rates for which the
format has none are written in seconds. Import goes by the order of the selection as well as by
names, so the script is the safer way; this file has not been tried in Maya.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from pathlib import Path

from stages.files import errors

WORDS = {
    Fraction(15): "game",
    Fraction(24): "film",
    Fraction(25): "pal",
    Fraction(30): "ntsc",
    Fraction(48): "show",
    Fraction(50): "palf",
    Fraction(60): "ntscf",
}
# further units that Maya's own settings have
THOUSANDTHS = {
    Fraction(24000, 1001): "23.976fps",
    Fraction(30000, 1001): "29.97fps",
    Fraction(48000, 1001): "47.952fps",
    Fraction(60000, 1001): "59.94fps",
}
WHOLE = (2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 40, 75, 80, 100, 120, 125, 150, 200, 240, 250, 300)
SETTINGS = WORDS | THOUSANDTHS | {Fraction(rate): f"{rate}fps" for rate in WHOLE}
NODE = "blendShape1"
HEADER = ("animVersion 1.1;", "mayaVersion 2022;")
CURVE = (
    "animData {",
    "  input time;",
    "  output unitless;",
    "  weighted 0;",
    "  preInfinity constant;",
    "  postInfinity constant;",
    "  keys {",
)


def time_unit(path: str | Path, rate: Fraction) -> str:
    """Return Maya's setting for a rate.

    Raises
    ------
    errors.InputError
        if Maya has none
    """
    if rate not in SETTINGS:
        message = f"{rate} frames/s is no time unit of Maya: give the character another rate"
        raise errors.InputError(path, message)
    return SETTINGS[rate]


def write(
    path: str | Path,
    names: Sequence[str],
    curves: Iterable[list[list[float]]],
    frame: tuple[int, int],
    rate: Fraction,
) -> None:
    """Write curves.

    Parameters
    ----------
    path : the file
    names : of the targets
    curves : keys `[frame, value]` of each
    frame : the first and the last of the take
    rate : frames per second
    """
    lines = [*HEADER, f"timeUnit {WORDS.get(rate, 'sec')};", "linearUnit cm;", "angularUnit deg;"]
    lines += [f"startTime {_time(frame[0], rate)};", f"endTime {_time(frame[1], rate)};"]
    for index, (name, keys) in enumerate(zip(names, curves, strict=True)):
        lines += [f"anim {name} {name} {NODE} 0 0 {index};", *CURVE]
        lines += [
            f"    {_time(number, rate)} {value:.9g} linear linear 1 1 0;" for number, value in keys
        ]
        lines += ["  }", "}"]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _time(frame: int, rate: Fraction) -> str:
    """Return a frame's time in the file's unit."""
    return str(frame) if rate in WORDS else repr(float(frame / rate))
