"""Polygons to triangles, and smooth normals."""

import numpy as np


def triangulate(sizes: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Cut every polygon into a fan of triangles about its first corner.

    Parameters
    ----------
    sizes : (F,) int array, corners of each polygon
    corners : (sum of sizes,) int array, vertex indices, polygon by polygon

    Returns
    -------
    (N, 3) int32 array, in the polygons' order and winding
    """
    fans = np.maximum(sizes - 2, 0)
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]) if len(sizes) else np.zeros(0, int)
    first = np.repeat(starts, fans)
    step = np.arange(fans.sum()) - np.repeat(np.cumsum(fans) - fans, fans)
    places = np.stack([first, first + step + 1, first + step + 2], axis=1)
    return np.asarray(corners, np.int32)[places]


def face_normals(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the (N, 3) normals of triangles, as long as twice their areas."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def corner_sum(triangles: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Add a value of each triangle to its three vertices.

    Parameters
    ----------
    triangles : (N, 3) int array
    values : (N, 3) float array
    count : V

    Returns
    -------
    (V, 3) float array
    """
    flat = triangles.T.ravel()
    return np.stack(
        [np.bincount(flat, np.tile(values[:, axis], 3), count) for axis in range(3)], axis=1
    )


def vertex_normals(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Average the normals of the triangles round each vertex, weighted by area.

    Parameters
    ----------
    vertices : (V, 3) float array
    triangles : (N, 3) int array

    Returns
    -------
    (V, 3) float array of length one; +z where a vertex has no area round it
    """
    total = corner_sum(triangles, face_normals(vertices, triangles), len(vertices))
    length = np.linalg.norm(total, axis=1, keepdims=True)
    flat = length[:, 0] <= np.finfo(float).tiny
    normals = total / np.where(length > 0, length, 1.0)
    return np.where(flat[:, None], [0.0, 0.0, 1.0], normals)
