"""Curves of any kind that is read, told by what the file holds and not by its name."""

from collections.abc import Sequence
from pathlib import Path

from stages.files import (
    curve_columns,
    curve_json,
    curve_take,
    errors,
    headed_text,
    json_stream,
    live_link,
    shape_names,
)

KNOWN = (
    "a take of Live Link Face, a table with columns such as jawOpen, or JSON frames of such weights"
)


def read(path: str | Path, table: Sequence[shape_names.Shape]) -> curve_take.CurveTake:
    """Read a take of curves.

    Raises
    ------
    errors.InputError
        if the file is missing, of no known form, or cannot be read
    """
    if not Path(path).is_file():
        raise errors.InputError(path, "no such curves: check the column curves of shots.tsv")
    if json_stream.starts_as_json(path):
        return curve_json.read(path, table)
    sheet = headed_text.read(path)
    if live_link.is_live_link(sheet.header):
        return live_link.read(path, sheet, table)
    if curve_columns.channels(sheet.header, table):
        return curve_columns.read(path, sheet, table)
    first = ", ".join(sheet.header[:4])
    raise errors.InputError(path, f"holds no curves, it starts '{first[:60]}': give {KNOWN}")
