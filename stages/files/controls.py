"""Control tables: a pose of named controls of a rig (sliders, joints, control points).

A comma-separated table `name,value`, one row a control, the same names in every pose of a
character. Names are free, for example `jaw` or `curve3.cv[12].x`; their order is the neutral's.
"""

from pathlib import Path

from stages.files import delimited, errors

# columns of the curves that controls are baked to
TAKEN = ("frame", "time_s")


def read(path: str | Path) -> dict[str, float]:
    """Read a pose.

    Returns
    -------
    control -> value, in the file's order

    Raises
    ------
    errors.InputError
        naming the line of a doubled name or of a value that is no number
    """
    pose = {}
    for row in delimited.read(path, ("name", "value"), separator=","):
        name = row.cells["name"]
        if name in TAKEN or "," in name:
            message = f"line {row.line}: a control cannot be called '{name}': rename it"
            raise errors.InputError(path, message)
        if not name or name in pose:
            what = f"control '{name}' stands twice" if name else "a control has no name"
            raise errors.InputError(path, f"line {row.line}: {what}: one row a control")
        pose[name] = delimited.number(path, row, "value")
    if not pose:
        raise errors.InputError(path, "names no control: one row `name,value` for each")
    return pose


def in_order(path: str | Path, pose: dict[str, float], names: list[str]) -> list[float]:
    """Return a pose's values in the order of the neutral's names.

    Raises
    ------
    errors.InputError
        naming a control that only one of the two has
    """
    for name in names:
        if name not in pose:
            raise errors.InputError(path, f"control {name} of the neutral is missing: add its row")
    for name in pose:
        if name not in names:
            raise errors.InputError(path, f"the neutral has no control {name}: correct the name")
    return [pose[name] for name in names]
