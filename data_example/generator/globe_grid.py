"""Lay a planet's skin out: a grid of quads with blocks left out for four mouths and five eyes.

The chart is the flat map of the sphere: angle from the front [rad], in its direction. Blocks are
pinned where the features shall be; what lies between settles like a net of springs.
"""

import itertools
from typing import NamedTuple

import numpy as np

SIDE = 18
RIM = np.deg2rad(100.0)
BEHIND = np.deg2rad([126.0, 153.0])
STEPS = 400


class Site(NamedTuple):
    """Where a feature sits.

    block : first column and row of the grid, columns, rows
    at : degrees to the creature's left and up
    half : half its width and half its height with its surround [degrees]
    tilt : counter-clockwise, as seen [degrees]
    """

    block: tuple
    at: tuple
    half: tuple
    tilt: float


SITES = {
    "mouth_grand": Site((7, 4, 6, 3), (5, -34), (25, 15), 4),
    "mouth_askew": Site((1, 5, 4, 3), (-49, -13), (18, 13), 14),
    "mouth_sleepy": Site((8, 14, 5, 3), (25, 42), (19, 12), -12),
    "mouth_prim": Site((14, 4, 3, 3), (53, -21), (14.5, 13), 24),
    "eye_moon": Site((5, 9, 4, 4), (-17, 13), (17.5, 17), 0),
    "eye_middle": Site((10, 8, 3, 3), (21, 8), (13, 12), -6),
    "eye_north": Site((3, 14, 3, 3), (-38, 42), (12.5, 12), 14),
    "eye_east": Site((14, 10, 3, 3), (53, 20), (11.5, 11), -12),
    "eye_south": Site((3, 1, 3, 3), (-40, -45), (11.5, 10.5), 10),
}


def exponential(flat):
    """Return the unit directions of places in the chart, (N, 3)."""
    angle = np.linalg.norm(flat, axis=-1, keepdims=True)
    away = flat / np.maximum(angle, 1e-12)
    return np.concatenate([np.sin(angle) * away, np.cos(angle)], axis=-1)


def chart(directions):
    """Return the places in the chart of unit directions, (N, 2)."""
    flat = directions[..., :2]
    sine = np.linalg.norm(flat, axis=-1, keepdims=True)
    angle = np.arctan2(sine, directions[..., 2:])
    return angle * flat / np.maximum(sine, 1e-12)


def axes(site):
    """Return a site's own axes as columns: along it, up and outwards, (3, 3)."""
    lon, lat = np.deg2rad(site.at)
    out = np.array([np.sin(lon) * np.cos(lat), np.sin(lat), np.cos(lon) * np.cos(lat)])
    east = np.array([np.cos(lon), 0.0, -np.sin(lon)])
    north = np.cross(out, east)
    c, s = np.cos(np.deg2rad(site.tilt)), np.sin(np.deg2rad(site.tilt))
    return np.stack([c * east + s * north, c * north - s * east, out], axis=1)


def wrapped(site, flat, radius):
    """Return points over the sphere from places about a site [rad] and radii, (N, 3)."""
    return np.broadcast_to(radius, len(flat))[:, None] * (exponential(flat) @ axes(site).T)


def ring(site):
    """Return a block's border, from its right corner along the lower side and back, (N, 2) int."""
    column, row, wide, high = site.block
    below = [(column, row + r) for r in range(high // 2, -1, -1)]
    below += [(column + c, row) for c in range(1, wide + 1)]
    below += [(column + wide, row + r) for r in range(1, high - high // 2)]
    above = [(column + wide, row + r) for r in range(high - high // 2, high + 1)]
    above += [(column + c, row + high) for c in range(wide - 1, -1, -1)]
    above += [(column, row + r) for r in range(high - 1, high // 2, -1)]
    return np.array(below + above)


def oval(site):
    """Return the border that a site's block is pinned to, in its own chart, (N, 2) [rad]."""
    angle = 2 * np.pi * np.arange(len(ring(site))) / len(ring(site))
    across, up = np.deg2rad(site.half)
    return np.stack([-across * np.cos(angle), -up * np.sin(angle)], axis=1)


class Grid(NamedTuple):
    """The skin at rest.

    directions : (V, 3) float array, unit vectors
    faces : list of quads, counter-clockwise from outside
    borders : dict, site -> (N,) vertex numbers of its border
    peaks : (V,) float array, 1 on every fourth vertex, where spikes may rise
    """

    directions: np.ndarray
    faces: list
    borders: dict
    peaks: np.ndarray


def _settled():
    """Return the chart's places of the whole front grid, (SIDE + 1, SIDE + 1, 2) [rad]."""
    u, v = np.meshgrid(*2 * (np.linspace(-1, 1, SIDE + 1),))
    places = RIM * np.stack([u * np.sqrt(1 - v * v / 2), v * np.sqrt(1 - u * u / 2)], axis=-1)
    pinned = np.zeros(u.shape, bool)
    pinned[[0, -1]] = pinned[:, [0, -1]] = True
    for site in SITES.values():
        columns, rows = ring(site).T
        places[rows, columns] = chart(wrapped(site, oval(site), 1.0))
        column, row, wide, high = site.block
        pinned[row : row + high + 1, column : column + wide + 1] = True
    for _ in range(STEPS):
        mean = sum(np.roll(places, step, axis) for step in (1, -1) for axis in (0, 1))
        places = np.where(pinned[..., None], places, mean / 4)
    return places


def _frame(count):
    """Return the border of the whole grid counter-clockwise from its first corner, (N, 2) int."""
    run = np.arange(count)
    zero, full = np.zeros(count, int), np.full(count, count)
    sides = ((run, zero), (full, run), (count - run, full), (zero, count - run))
    return np.concatenate([np.stack(side, axis=1) for side in sides])


def build():
    """Return the skin of the planet."""
    places = _settled()
    left_out = np.zeros((SIDE + 1, SIDE + 1), bool)
    cells = np.ones((SIDE, SIDE), bool)
    for site in SITES.values():
        column, row, wide, high = site.block
        left_out[row + 1 : row + high, column + 1 : column + wide] = True
        cells[row : row + high, column : column + wide] = False
    number = np.full(left_out.shape, -1)
    number[~left_out] = np.arange((~left_out).sum())
    faces = [
        (number[r, c], number[r, c + 1], number[r + 1, c + 1], number[r + 1, c])
        for r, c in np.argwhere(cells)
    ]
    frame = _frame(SIDE)
    turn = np.arctan2(*places[frame[:, 1], frame[:, 0]].T[::-1])
    back = [exponential(a * np.stack([np.cos(turn), np.sin(turn)], axis=1)) for a in BEHIND]
    rings = [number[frame[:, 1], frame[:, 0]]]
    count = int((~left_out).sum())
    for _ in back:
        rings.append(count + np.arange(len(frame)))
        count += len(frame)
    for inner, outer in itertools.pairwise(rings):
        ahead = np.roll(inner, -1), np.roll(outer, -1)
        faces += zip(inner, outer, ahead[1], ahead[0], strict=True)
    last = rings[-1]
    faces += [(count, last[i], last[i - 1], last[i - 2]) for i in range(0, len(last), 2)]
    even = np.zeros(left_out.shape)
    even[::2, ::2] = 1.0
    around = np.arange(len(frame)) % 2 == 0
    peaks = np.concatenate([even[~left_out], *((around + 0.0) * (k == 0) for k in range(2)), [0]])
    directions = np.concatenate([exponential(places[~left_out]), *back, [[0, 0, -1.0]]])
    borders = {name: number[tuple(ring(site).T[::-1])] for name, site in SITES.items()}
    return Grid(directions, [tuple(int(v) for v in f) for f in faces], borders, peaks)
