"""Drawings of contours for web pages: SVG paths in face units, y up."""

from collections.abc import Sequence

import numpy as np

from stages.files import point_set

MARGIN = 0.15
CROSS = 0.03  # face units, half the arm of the cross that marks a single point


def rows_by_contour(
    names: Sequence[str], chosen: np.ndarray, contours: Sequence[point_set.Contour]
) -> list[tuple[list[int], bool]]:
    """Return the rows of each contour's chosen points, and whether it is closed.

    Parameters
    ----------
    names : names of the P points
    chosen : (Q,) int array, rows of the points to draw
    contours : all contours of the point set
    """
    owners = [point_set.contour_of(name) for name in names]
    parts = []
    for contour in contours:
        rows = [int(row) for row in chosen if contour.name in (owners[row], names[row])]
        if rows:
            parts.append((rows, contour.kind == "closed"))
    return parts


def paths(points: np.ndarray, parts: Sequence[tuple[list[int], bool]]) -> list[str]:
    """Return the SVG paths of (P, 2) points; a contour with an unknown point is left out."""
    return [
        _path(points[rows], closed) for rows, closed in parts if np.isfinite(points[rows]).all()
    ]


def _path(points: np.ndarray, closed: bool) -> str:
    """Return the `d` of a path through (N, 2) points; a single point becomes a cross."""
    if len(points) == 1:
        x, y = points[0]
        return f"M{x - CROSS:.4f} {y:.4f}h{2 * CROSS}M{x:.4f} {y - CROSS:.4f}v{2 * CROSS}"
    steps = " ".join(f"{x:.4f} {y:.4f}" for x, y in points)
    return f"M{steps}{'Z' if closed else ''}"


def dots(points: np.ndarray, neutral: np.ndarray) -> list[dict[str, str]]:
    """Return where points (P, 2 or 3) lie and where the neutral has them, those that are known."""
    return [
        {
            "x": f"{place[0]:.4f}",
            "y": f"{place[1]:.4f}",
            "from_x": f"{rest[0]:.4f}",
            "from_y": f"{rest[1]:.4f}",
        }
        for place, rest in zip(points, neutral, strict=True)
        if np.isfinite(place[:2]).all()
    ]


def window(points: np.ndarray) -> dict[str, str]:
    """Return `view_box` and `stroke` of a square drawing, y down, that holds (N, 2) points."""
    known = points[np.isfinite(points).all(axis=1)]
    low, high = known.min(axis=0), known.max(axis=0)
    side = (high - low).max() * (1 + 2 * MARGIN)
    left, bottom = (low + high - side) / 2
    box = f"{left:.4f} {-bottom - side:.4f} {side:.4f} {side:.4f}"
    return {"view_box": box, "stroke": f"{side / 90:.4f}"}
