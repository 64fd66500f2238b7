"""Find how much light reaches each vertex past the rest of the mesh."""

import numpy as np

from data_example.generator import raster

SIZE = 320
FOCAL = 2600.0
DISTANCE = 3200.0
BIAS_MM = 3.0


def _spread(count):
    """Return unit directions spread evenly over the sphere, (count, 3)."""
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    around = np.pi * (1 + 5**0.5) * i
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(around), z, flat * np.sin(around)], axis=1)


def _frame(direction):
    """Return the (3, 3) rotation whose rows are right, up and towards the light."""
    up = np.array([0.0, 0.0, 1.0]) if abs(direction[1]) > 0.9 else np.array([0.0, 1.0, 0.0])
    right = np.cross(up, direction)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(direction, right), direction])


def ambient(vertices, faces, normals, centre, count=64):
    """Return the part of the sky that each vertex sees, weighted by the cosine, (V,).

    Parameters
    ----------
    vertices : (V, 3) float array [mm]
    faces : (F, 3) int array
    normals : (V, 3) float array, unit length
    centre : (3,) float array, middle of what is lit [mm]
    count : int, number of directions
    """
    seen, possible = np.zeros(len(vertices)), np.full(len(vertices), 1e-6)
    nothing = np.zeros((len(vertices), 1))
    for direction in _spread(count):
        facing = np.maximum(normals @ direction, 0)
        q = (vertices - centre) @ _frame(direction).T - [0, 0, DISTANCE]
        _, depth = raster.fill(q, faces, nothing, (SIZE, SIZE), FOCAL)
        x = SIZE / 2 - FOCAL * q[:, 0] / q[:, 2]
        y = SIZE / 2 + FOCAL * q[:, 1] / q[:, 2]
        column, row = (np.clip(np.floor(v).astype(int), 0, SIZE - 1) for v in (x, y))
        open_ = -q[:, 2] < depth[row, column] + BIAS_MM
        # the sky above gives more light than the floor
        weight = facing * (0.65 + 0.35 * direction[1])
        seen += weight * open_
        possible += weight
    return seen / possible
