"""`weights.parquet` and `weights.csv`: what is baked, at the character's rate.

Columns: `<mask>.<shape>` for every shape of the rig, `head.rotation.x|y|z|w`,
`head.translation.x|y|z` [face units], `head.scale` and `confidence`, 0 where a frame was filled.
Head motion stands in the face's axes (y up, +x the subject's left), whatever the character's.
"""

import dataclasses
import math
import re
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages.core import timecode
from stages.files import atomic, errors, series

KIND = "weights"
ROTATION = [f"head.rotation.{axis}" for axis in "xyzw"]
TRANSLATION = [f"head.translation.{axis}" for axis in "xyz"]
SCALE = "head.scale"


@dataclasses.dataclass(frozen=True)
class Weights:
    """What moves a rig.

    Attributes
    ----------
    frame : (T,) int array
    rate : frames per second
    shapes : (T, K) float array, `u_li` in the order of the rig's names
    rotation : (T, 4) float array, x, y, z, w
    translation : (T, 3) float array [face units]
    scale : (T,) float array
    confidence : (T,) float array in 0..1
    start_timecode : of time 0, or an empty text
    timecode_rate : frames per second in which it counts
    """

    frame: np.ndarray
    rate: Fraction
    shapes: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    scale: np.ndarray
    confidence: np.ndarray
    start_timecode: str
    timecode_rate: Fraction

    @property
    def midnight_s(self) -> Fraction:
        """Time 0 as a time of day [s]; 0 where no timecode is known."""
        if not self.start_timecode:
            return Fraction(0)
        return timecode.parse(self.start_timecode, self.timecode_rate) / self.timecode_rate

    @property
    def first_timecode(self) -> str:
        """The timecode of the first frame, or an empty text."""
        if not self.start_timecode:
            return ""
        passed = Fraction(int(self.frame[0])) / self.rate * self.timecode_rate
        count = timecode.parse(self.start_timecode, self.timecode_rate) + math.floor(passed)
        drops = not re.fullmatch("[0-9:]*", self.start_timecode)
        return timecode.write(count, self.timecode_rate, drops)

    @property
    def time_s(self) -> np.ndarray:
        """The times of the frames (T,) [s]."""
        return _time_s(self.frame, self.rate)


def head_columns(rotation: np.ndarray, rest: np.ndarray) -> dict[str, np.ndarray]:
    """Name the columns of (T, 4) rotations and of (T, 4) translations with scales."""
    values = np.concatenate([rotation, rest], axis=1)
    return dict(zip([*ROTATION, *TRANSLATION, SCALE], values.T, strict=True))


def write(
    path: str | Path,
    csv_path: str | Path,
    frame: np.ndarray,
    columns: dict[str, np.ndarray],
    rate: Fraction,
    meta: dict | None = None,
    sources: Iterable[str | Path] = (),
) -> None:
    """Write both files; columns are (T,) float arrays by name, meta may hold the timecode."""
    time_s = _time_s(frame, rate)
    series.write(path, KIND, frame, time_s, columns, rate, meta, sources)
    write_csv(csv_path, frame, time_s, columns)


def _time_s(frame: np.ndarray, rate: Fraction) -> np.ndarray:
    """Return the times of frames of a rate [s], each rounded once."""
    return frame * rate.denominator / rate.numerator


def write_csv(
    path: str | Path, frame: np.ndarray, time_s: np.ndarray, columns: dict[str, np.ndarray]
) -> None:
    """Write curves as comma-separated text: frame, time_s, then a column for each."""
    values = np.zeros((len(frame), len(columns)), np.float32)
    for column, curve in enumerate(columns.values()):
        values[:, column] = curve
    with (
        atomic.replacing(path) as temporary,
        temporary.open("w", encoding="utf-8", newline="\n") as stream,
    ):
        stream.write(",".join(["frame", "time_s", *columns]) + "\n")
        for number, time, row in zip(frame, time_s, values, strict=True):
            # nine digits give every float32 back
            cells = [str(number), f"{time:.6f}", *(f"{value:.9g}" for value in row)]
            stream.write(",".join(cells) + "\n")


def read(path: str | Path, names: list[str]) -> Weights:
    """Read the weights of a rig with the given names.

    Raises
    ------
    errors.InputError
        naming a column that is missing, or the frame of a value that is not finite
    """
    read_series = series.read(path, KIND)
    wanted = [*names, *ROTATION, *TRANSLATION, SCALE, "confidence"]
    for name in wanted:
        if name not in read_series.columns:
            raise errors.InputError(path, f"column {name} is missing: run smooth_weights again")
    values = np.stack([read_series.columns[name] for name in wanted], axis=1)
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        message = f"frame {read_series.frame[bad[0, 0]]}, column {wanted[bad[0, 1]]}: not finite"
        raise errors.InputError(path, message + ", run smooth_weights again")
    parts = np.split(values, np.cumsum([len(names), 4, 3, 1]), axis=1)
    shapes, rotation, translation, scale, confidence = parts
    return Weights(
        read_series.frame,
        read_series.rate,
        shapes,
        rotation,
        translation,
        scale[:, 0],
        confidence[:, 0],
        read_series.meta.get("start_timecode", ""),
        Fraction(read_series.meta.get("timecode_rate", read_series.rate)),
    )
