"""The tables that describe a show, validated row by row against their schemas.

A schema is a JSON schema of one row, written in YAML, with two additions: `key` names the columns
that together are unique, and `default` of a property stands for a blank cell or a missing column.
Cells are strings (shot `0010` keeps its zeros).
"""

from collections.abc import Sequence
from pathlib import Path

import jsonschema.protocols
import yaml

from stages.files import delimited, errors

Table = list[delimited.Row]


def read(path: str | Path, schema_path: str | Path) -> Table:
    """Read a table and check it against its schema.

    Raises
    ------
    errors.InputError
        naming line and column of the first fault
    """
    schema = yaml.safe_load(Path(schema_path).read_text(encoding="utf-8"))
    properties = schema["properties"]
    required = schema["required"]
    rows = delimited.read(path, required, [name for name in properties if name not in required])
    defaults = {name: rule.get("default", "") for name, rule in properties.items()}
    complete = [
        delimited.Row(row.line, defaults | {k: v for k, v in row.cells.items() if v})
        for row in rows
    ]
    validator = jsonschema.Draft202012Validator(schema)
    for row in complete:
        _check_row(path, row, validator, properties)
    _check_key(path, complete, schema["key"])
    return complete


def _check_row(
    path: str | Path,
    row: delimited.Row,
    validator: jsonschema.protocols.Validator,
    properties: dict,
) -> None:
    """Check the cells of one row that are not blank, and that no required one is blank."""
    filled = {column: cell for column, cell in row.cells.items() if cell}
    for fault in validator.iter_errors(filled):
        place = f"line {row.line}"
        if fault.validator == "required":
            missing = next(name for name in fault.validator_value if name not in filled)
            raise errors.InputError(path, f"{place}, column {missing}: the cell is blank, fill it")
        column = fault.path[0]
        meaning, choices = properties[column]["description"], properties[column].get("enum")
        message = f"{place}, column {column}: '{filled[column]}' does not fit; it is: {meaning}"
        message += f"; write one of {', '.join(choices)}" if choices else ""
        raise errors.InputError(path, message)


def _check_key(path: str | Path, rows: Table, key: Sequence[str]) -> None:
    """Refuse two rows with the same key."""
    seen: dict[tuple[str, ...], int] = {}
    for row in rows:
        values = tuple(row.cells[column] for column in key)
        if values in seen:
            names = ", ".join(f"{c} {v}" for c, v in zip(key, values, strict=True))
            message = f"line {row.line}: {names} stands on line {seen[values]} already; remove one"
            raise errors.InputError(path, message)
        seen[values] = row.line


def check_references(
    path: str | Path, rows: Table, column: str, known: Sequence[str], where: str
) -> None:
    """Refuse a cell that names something which another table does not hold.

    Parameters
    ----------
    path : the table's file
    rows : its rows
    column : the referring column; its cell may be blank or list names with commas
    known : the names that exist
    where : the table that should hold them

    Raises
    ------
    errors.InputError
        naming line, column and cell
    """
    for row in rows:
        for name in listed(row.cells[column]):
            if name not in known:
                message = f"line {row.line}, column {column}: '{name}' is not in {where}"
                raise errors.InputError(path, message + "; add it there or correct the name")


def listed(cell: str) -> list[str]:
    """Return the names in a cell that may list several with commas."""
    return [name.strip() for name in cell.split(",") if name.strip()]
