"""Light on a moving mesh: colours at its vertices, for the rasteriser to interpolate."""

import numpy as np

# towards the lights, in the camera's axes: x right, y up, z to the viewer
KEY = np.array([-0.45, 0.55, 0.70])
FILL = np.array([0.75, 0.05, 0.45])
KEY_COLOUR = np.array([1.00, 0.96, 0.90]) * 0.82
FILL_COLOUR = np.array([0.72, 0.82, 1.00]) * 0.30
AMBIENT = np.array([0.20, 0.20, 0.22])
CLAY = (0.80, 0.74, 0.69)
GAMMA = 2.2


def outward(
    vertices: np.ndarray, triangles: np.ndarray, face_normals: np.ndarray, back: np.ndarray
) -> float:
    """Return 1 where triangles wind round normals that point out of the mesh, else -1.

    A closed mesh tells by its volume; an open one, such as a flat drawing, by which way most of
    it faces.

    Parameters
    ----------
    vertices : (V, 3) float array
    triangles : (N, 3) int array
    face_normals : (N, 3) float array, as long as twice the areas
    back : (3,) float array, direction to the viewer
    """
    centred = vertices - vertices.mean(axis=0)
    facing = face_normals.sum(axis=0) @ back
    area = np.linalg.norm(face_normals, axis=1).sum()
    if abs(facing) > 0.05 * area:
        return 1.0 if facing > 0 else -1.0
    volume = np.sum(centred[triangles[:, 0]] * face_normals)
    return 1.0 if volume >= 0 else -1.0


def vertex_light(normals: np.ndarray, albedo: np.ndarray) -> np.ndarray:
    """Light matt vertices by a key, a fill and what comes from everywhere.

    The key wraps a little round the form, so that the shaded side keeps its relief.

    Parameters
    ----------
    normals : (V, 3) float array of length one, in the camera's axes
    albedo : (V, 3) float array in 0..1, as displayed

    Returns
    -------
    (V, 3) float32 array in 0..1, as displayed
    """
    key = np.clip((normals @ (KEY / np.linalg.norm(KEY)) + 0.15) / 1.15, 0.0, None)
    fill = np.clip(normals @ (FILL / np.linalg.norm(FILL)), 0.0, None)
    light = AMBIENT + key[:, None] * KEY_COLOUR + fill[:, None] * FILL_COLOUR
    return np.clip((albedo**GAMMA * light) ** (1 / GAMMA), 0.0, 1.0).astype(np.float32)
