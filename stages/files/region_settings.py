"""`region_settings.tsv`: how each region's key shapes are chosen and its weights solved."""

import dataclasses
from collections.abc import Iterable
from pathlib import Path

from stages.files import delimited, errors

AUTOMATIC = ("knee", "budget")
DEFAULTS = {
    "budget": "",
    "method": "shared_residual",
    "solve": "tolerant_even",
    "sigma": "0.1",
    "bound": "",
}


@dataclasses.dataclass(frozen=True)
class Settings:
    """One region's settings.

    Attributes
    ----------
    count : number of key shapes, `knee` or `budget`
    budget : held-out error that `budget` may reach [face units], or None
    method : how key shapes are chosen
    solve : what the weights minimise
    sigma : relative error expected of a sculpt
    bound : weights stay within -bound and 1 + bound, or None for what the solve does by itself
    """

    count: int | str
    budget: float | None
    method: str
    solve: str
    sigma: float
    bound: float | None


def read(path: str | Path, regions: Iterable[str]) -> dict[str, Settings]:
    """Read the settings of all regions.

    Raises
    ------
    errors.InputError
        naming line and column, or a region that has no row
    """
    found: dict[str, Settings] = {}
    for row in delimited.read(path, ("region", "count"), tuple(DEFAULTS)):
        cells = DEFAULTS | {name: cell for name, cell in row.cells.items() if cell}
        filled = delimited.Row(row.line, cells)
        region = cells["region"]
        if region in found:
            message = f"line {row.line}, column region: {region} stands twice, remove one row"
            raise errors.InputError(path, message)
        automatic = cells["count"] in AUTOMATIC
        if cells["count"] == "budget" and not cells["budget"]:
            message = f"line {row.line}, column budget: count is 'budget', so give the budget"
            raise errors.InputError(path, message)
        found[region] = Settings(
            cells["count"] if automatic else delimited.whole_number(path, filled, "count"),
            delimited.number(path, filled, "budget") if cells["budget"] else None,
            cells["method"],
            cells["solve"],
            delimited.number(path, filled, "sigma"),
            delimited.number(path, filled, "bound") if cells["bound"] else None,
        )
    for region in regions:
        if region not in found:
            raise errors.InputError(
                path, f"region {region} has no row: add one, or drop it from regions.tsv"
            )
    return found
