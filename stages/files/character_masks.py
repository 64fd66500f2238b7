"""The masks of a character over its vertices, from a table or from painted vertex colours.

To paint them: copy the neutral, give the copy a colour attribute per vertex in floats or bytes,
fill it with pure red, green and blue where one mask alone holds, blend where masks meet, and export
it as .ply with its colours as they are (in Blender: colours `Linear`). Do not move, join or split
vertices. Each vertex is divided by the sum of its three channels, so brightness does not matter.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stages.core import masks
from stages.files import errors, mask_table, mesh, sculpts

PAINTED = ".ply"
CHANNELS = ("red", "green", "blue")
# how far a painted copy may be from the neutral, as a share of its size: other formats round
SAME_PLACE = 1e-4


def read(
    path: str | Path, painted: Sequence[str], neutral: sculpts.Pose
) -> tuple[list[str], np.ndarray]:
    """Read a character's masks, a table or a painted mesh by the file's suffix.

    Parameters
    ----------
    path : a masks table, or a .ply
    painted : the masks that red, green and blue stand for; none for a table
    neutral : the character's neutral

    Returns
    -------
    names of the R masks
    values : (R, V) float array, one at every vertex in sum

    Raises
    ------
    errors.InputError
        naming the vertex, the line, or what is missing
    """
    if Path(path).suffix.lower() == PAINTED:
        return _from_paint(path, painted, neutral)
    if painted:
        message = f"is a table, which names its masks itself: leave {', '.join(painted)} out"
        raise errors.InputError(path, message + " of painted_masks")
    return from_table(path, neutral)


def from_table(path: str | Path, neutral: sculpts.Pose) -> tuple[list[str], np.ndarray]:
    """Read the masks of a table; what is returned and raised is that of `read`."""
    points = neutral.coordinates
    table = mask_table.read(path, neutral.names, points.shape[1])
    values = table.given
    if table.rest is not None:
        values = masks.by_ramps(points, len(table.regions), table.rest, table.ramps, table.listed)
    fault = masks.first_fault(values)
    if fault:
        vertex, what = fault
        held = [
            f"{region} {weight:g}"
            for region, weight in zip(table.regions, values[:, vertex], strict=True)
            if weight
        ]
        message = f"vertex {neutral.names[vertex]}: {what} ({', '.join(held) or 'not listed'})"
        raise errors.InputError(path, message + ": correct its rows")
    return table.regions, masks.normalised(values)


def _from_paint(
    path: str | Path, names: Sequence[str], neutral: sculpts.Pose
) -> tuple[list[str], np.ndarray]:
    """Read the masks of a painted copy of the neutral."""
    if len(set(names)) != len(CHANNELS) or not all(names):
        message = f"painted_masks is '{','.join(names)}': name three masks, for red, green and blue"
        raise errors.InputError(path, message)
    if neutral.is_controls:
        raise errors.InputError(path, "controls have no colours: give a table of masks")
    copy = mesh.read(path)
    _refuse_other_vertices(path, copy.vertices, neutral.coordinates)
    if not len(copy.colours):
        raise errors.InputError(path, "has no vertex colours: paint them, export with colours")
    black = np.flatnonzero(copy.colours.sum(axis=1) == 0)
    if len(black):
        message = f"vertex {black[0]} is black, so it follows no mask ({len(black)} such vertices)"
        raise errors.InputError(path, f"{message}: paint it {', '.join(CHANNELS)} or a mixture")
    return list(names), masks.normalised(copy.colours.T)


def _refuse_other_vertices(path: str | Path, found: np.ndarray, wanted: np.ndarray) -> None:
    """Fail if a painted copy has other vertices than the neutral (V, 3), or in another order."""
    if found.shape != wanted.shape:
        message = f"has {len(found)} vertices, the neutral has {len(wanted)}"
        raise errors.InputError(path, message + ": paint a copy of the neutral, split nothing")
    size = np.linalg.norm(np.ptp(wanted, axis=0))
    away = np.flatnonzero(np.linalg.norm(found - wanted, axis=1) > SAME_PLACE * size)
    if len(away):
        message = f"vertex {away[0]} is not where the neutral has it ({len(away)} such vertices)"
        raise errors.InputError(path, message + ": paint a copy of the neutral, in its order")
