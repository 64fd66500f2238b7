"""Put a character's pieces together: vertices in a fixed order, faces, colours, masks."""

from typing import NamedTuple

import numpy as np


class Character(NamedTuple):
    """A character that can be posed.

    name : folder name
    pose : function from a dict of expression parameters to (V, 3) float array
    faces : list of tuples of vertex numbers, counter-clockwise from outside
    colours : (V, 3) float array, 0..1
    masks : list of rows of the masks table, the header first
    digits : int, digits after the point in its files
    row : dict, its cells of characters.tsv
    """

    name: str
    pose: object
    faces: list
    colours: np.ndarray
    masks: list
    digits: int
    row: dict


class Pieces:
    """Collect pieces in order: names, vertices, faces and colours."""

    def __init__(self):
        self.slices, self.faces, self.colours, self.count = {}, [], [], 0

    def add(self, name, count, faces, colour):
        """Add a piece of so many vertices with faces numbered from 0 and colours."""
        self.slices[name] = slice(self.count, self.count + count)
        self.faces += [tuple(int(v) + self.count for v in face) for face in faces]
        self.colours.append(np.broadcast_to(np.asarray(colour, float), (count, 3)))
        self.count += count

    def numbers(self, *starts):
        """Return the vertex numbers of pieces whose names start so, in order."""
        wanted = [s for name, s in self.slices.items() if name.startswith(starts)]
        return [v for s in wanted for v in range(s.start, s.stop)]


def grid(rows, columns, closed=False):
    """Return quads of a grid of vertices, row by row; turned towards a viewer of rows upwards."""
    faces = []
    for r in range(rows - 1):
        for c in range(columns if closed else columns - 1):
            d = (c + 1) % columns
            faces.append(
                (r * columns + c, r * columns + d, (r + 1) * columns + d, (r + 1) * columns + c)
            )
    return faces


def fan(count, start=0, centre=None):
    """Return triangles from a centre, the last vertex by default, to a ring."""
    centre = start + count if centre is None else centre
    return [(centre, start + i, start + (i + 1) % count) for i in range(count)]


def flipped(faces):
    """Return faces turned round."""
    return [tuple(reversed(face)) for face in faces]


def circle(count, radius_x, radius_y=None, start=0.0):
    """Return points of an ellipse counter-clockwise from a starting angle, (count, 2)."""
    angle = start + 2 * np.pi * np.arange(count) / count
    radius_y = radius_x if radius_y is None else radius_y
    return np.stack([radius_x * np.cos(angle), radius_y * np.sin(angle)], axis=1)


def ribbon(line, widths):
    """Return a stroke along a line: its lower side, then its upper side, (2 N, 2)."""
    widths = np.broadcast_to(widths, len(line))
    direction = np.gradient(line, axis=0)
    direction /= np.maximum(np.linalg.norm(direction, axis=1), 1e-9)[:, None]
    across = np.stack([-direction[:, 1], direction[:, 0]], axis=1) * widths[:, None] / 2
    return np.concatenate([line - across, line + across])


def raised(flat, z):
    """Return (N, 2) points as (N, 3) points at a depth."""
    return np.column_stack([flat, np.broadcast_to(z, len(flat))])
