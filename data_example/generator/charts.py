"""Make a head's skin: rings round mouth and eyes, set into a triangulated sphere of rays.

The chart is the flat map of the head: angle from the front times 85 mm, in its direction.
"""

import numpy as np
from scipy import spatial

from data_example.generator import fields, solids

MM = 85.0


def oval(count, centre, across, down, up):
    """Return an oval in the frontal plane in the order of the rings, (count, 2) [mm]."""
    angle = 2 * np.pi * np.arange(count) / count
    height = np.where(np.sin(angle) > 0, down, up)
    return np.stack(
        [centre[0] - across * np.cos(angle), centre[1] - height * np.sin(angle)], axis=1
    )


def to_chart(points, centre):
    """Return the places in the chart of points seen from a centre, (N, 2) [mm]."""
    d = points - centre
    flat = np.maximum(np.hypot(d[:, 0], d[:, 1]), 1e-9)
    angle = np.arctan2(flat, d[:, 2])
    return (MM * angle / flat)[:, None] * d[:, :2]


def directions(places):
    """Return the unit directions of places in the chart, (N, 3)."""
    length = np.linalg.norm(places, axis=1)
    flat = places / np.maximum(length, 1e-9)[:, None]
    angle = length / MM
    return np.concatenate([flat * np.sin(angle)[:, None], np.cos(angle)[:, None]], axis=1)


def in_front(distance, xy):
    """Return the (N, 3) points of a solid's surface in front of given x and y [mm]."""
    origins = np.column_stack([xy, np.zeros(len(xy))])
    ahead = np.tile([0.0, 0.0, 1.0], (len(xy), 1))
    return origins + solids.trace(distance, origins, ahead, 130)[:, None] * ahead


def around(distance, centre, places):
    """Return the (N, 3) points of a solid's surface at places of the chart [mm]."""
    rays = directions(places)
    origins = np.tile(np.asarray(centre, float), (len(rays), 1))
    return origins + solids.trace(distance, origins, rays, 290)[:, None] * rays


def patch(distance, border, outline, weights):
    """Return rings from a moving border to an outline on the skin, (R, N, 3) [mm].

    Near the border they take its depth, near the outline that of the modelled head.
    """
    result = []
    for w in weights:
        ring = border + w * (outline - border)
        modelled = in_front(distance, ring[:, :2])
        ring[:, 2] += fields.smoothstep(0, 1, np.array(w)) * (modelled[:, 2] - ring[:, 2])
        result.append(ring)
    return np.stack(result)


def within(points, outline, margin):
    """Return which points lie inside an outline or closer to it than a margin, (N,) bool."""
    a, b = outline, np.roll(outline, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    crosses = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    inside = (crosses & (x < at)).sum(axis=1) % 2 == 1
    return inside | (spatial.cKDTree(outline).query(points)[0] < margin)


def lattice(outlines, steps, extent, margin, seed, even=False):
    """Return places spread over the chart outside the outlines, (N, 2) [mm].

    Parameters
    ----------
    outlines : list of (M, 2) float arrays [mm]
    steps : (float, float), distance of neighbours in front and at the back [mm]
    extent : float, radius that is covered [mm]
    margin : float, distance kept from the outlines [mm]
    seed : int, turns the circles at random; None makes them alike on both sides
    even : bool, gives every circle an even number, so that it meets the middle line twice
    """
    rng = np.random.default_rng(seed)
    layers, radius = [], 0.0
    while radius < extent:
        step = steps[0] + (steps[1] - steps[0]) * fields.smoothstep(70, 150, radius)
        count = max(int(2 * np.pi * radius / step), 1)
        count += even and radius > 0 and count % 2
        start = count / 4 if seed is None else rng.random()
        angle = 2 * np.pi * (np.arange(count) + start) / count
        layers.append(radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        radius += step * 0.87
    points = np.concatenate(layers)
    for outline in outlines:
        points = points[~within(points, outline, margin)]
    return points


def ring_places(outline, count, smallest):
    """Return places of concentric rings inside an outline, innermost first, (count, N, 2)."""
    centre = outline.mean(axis=0)
    return np.stack([centre + f * (outline - centre) for f in np.linspace(smallest, 1, count)])


def strip(index, closed=True):
    """Return the triangles of a grid of vertex numbers whose columns may close to a ring."""
    following = np.roll(index, -1, axis=1) if closed else index[:, 1:]
    here = index if closed else index[:, :-1]
    a, b, c, d = here[:-1], following[:-1], following[1:], here[1:]
    first = np.stack([a, b, c], -1).reshape(-1, 3)
    return np.concatenate([first, np.stack([a, c, d], -1).reshape(-1, 3)])


def mesh(groups, places):
    """Return the triangles of ring groups set into a lattice.

    Parameters
    ----------
    groups : list of (R, N) int arrays, vertex numbers of rings from inside to outside
    places : (V, 2) float array, chart; vertices in no group are the lattice

    Returns
    -------
    faces : (F, 3) int array, turned outwards
    """
    used = np.concatenate([group.ravel() for group in groups])
    numbers = np.concatenate(
        [*(group[-1] for group in groups), np.setdiff1d(np.arange(len(places)), used)]
    )
    triangles = spatial.Delaunay(places[numbers]).simplices
    for group in groups:
        middle = places[numbers][triangles].mean(axis=1)
        triangles = triangles[~within(middle, places[group[-1]], 0.0)]
    a, b, c = places[numbers][triangles].transpose(1, 0, 2)
    turned = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    triangles[turned] = triangles[turned][:, ::-1]
    return np.concatenate([*(strip(group)[:, ::-1] for group in groups), numbers[triangles]])


def follow(points, ring):
    """Return the nearest place along a closed ring and the distance to it, two (N,) [mm]."""
    fine = 8
    closed = np.concatenate([ring, ring[:1]])
    at = np.arange(fine * len(ring)) / fine
    dense = np.stack([np.interp(at, np.arange(len(closed)), c) for c in closed.T], axis=1)
    distance, index = spatial.cKDTree(dense).query(points)
    return index / fine, distance


def at_ring(values, nearest):
    """Return values of a ring's points, (N, 3), interpolated at places along it, (M, 3)."""
    closed = np.concatenate([values, values[:1]])
    at = np.arange(len(closed))
    return np.stack([np.interp(nearest, at, column) for column in closed.T], axis=1)
