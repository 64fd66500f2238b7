"""Fill triangles with interpolated values, with a depth buffer, on one core."""

import cv2
import numpy as np

FAR = 5000.0
cv2.setNumThreads(1)


def _settings():
    """Return settings that interpolate and draw both sides of a triangle."""
    settings = cv2.TriangleRasterizeSettings()
    settings = settings.setCullingMode(cv2.RASTERIZE_CULLING_NONE)
    return settings.setShadingType(cv2.RASTERIZE_SHADING_SHADED)


def fill(vertices, faces, values, shape, focal):
    """Fill triangles before a camera in the origin that looks along -z.

    Parameters
    ----------
    vertices : (V, 3) float array, y up
    faces : (F, 3) int array
    values : (V, C) float array, interpolated over the triangles
    shape : (height, width) of the picture [px]
    focal : float [px]

    Returns
    -------
    picture : (height, width, C) float32 array, zero where nothing is
    depth : (height, width) float32 array, distance along the view, FAR where nothing is
    """
    triangles = np.ascontiguousarray(faces, dtype=np.int32)
    points = np.ascontiguousarray(vertices, dtype=np.float32)
    field = 2 * np.arctan(shape[0] / 2 / focal)
    camera = np.eye(4, dtype=np.float32)
    layers = []
    for first in range(0, values.shape[1], 3):
        three = np.zeros((len(points), 3), np.float32)
        part = values[:, first : first + 3]
        three[:, : part.shape[1]] = part
        picture = np.zeros((*shape, 3), np.float32)
        depth = np.full(shape, FAR, np.float32)
        picture, depth = cv2.triangleRasterize(
            points, triangles, three, picture, depth, camera, field, 0.1, FAR, _settings()
        )
        layers.append(picture[..., : part.shape[1]])
    return np.concatenate(layers, axis=2), depth


COVERED = 0.99 * FAR


def flat(places, faces, values, size):
    """Fill triangles of a flat map, places in pixels with y down, into a square picture."""
    half = size / 2
    points = np.stack(
        [(places[:, 0] - half) / half, (half - places[:, 1]) / half, np.full(len(places), -1.0)], 1
    )
    return fill(points, faces, values, (size, size), half)[0]
