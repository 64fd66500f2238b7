"""A character seen from before its face: one camera and one light for all of its poses."""

from collections.abc import Callable

import numpy as np

from stages.core import polygons, rasterize, shade


def painter(
    neutral: np.ndarray,
    triangles: np.ndarray,
    colours: np.ndarray,
    face_axes: np.ndarray,
    box: tuple[np.ndarray, np.ndarray],
    side: int,
) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function that draws poses of a mesh from a fixed camera.

    Parameters
    ----------
    neutral : (V, 3) float array, which tells the outside of the mesh from its inside
    triangles : (N, 3) int32 array
    colours : (V, 3) float array in 0..1; (0, 3) for clay
    face_axes : (3, 3) rotation whose columns are the face's left, up and forward directions
    box : two (3,) float arrays, the corners of what the camera shows
    side : of the picture [px]

    Returns
    -------
    function of (V, 3) float positions that gives a (side, side, 3) uint8 picture
    """
    camera = rasterize.facing_camera(*box, face_axes)
    behind = rasterize.backdrop(side)
    normals = polygons.face_normals(neutral, triangles)
    sign = shade.outward(neutral, triangles, normals, face_axes[:, 2])
    albedo = colours if len(colours) else np.tile(shade.CLAY, (len(neutral), 1))

    def paint(positions: np.ndarray) -> np.ndarray:
        positions = np.asarray(positions, np.float32)
        turned = sign * polygons.vertex_normals(positions, triangles) @ face_axes
        light = shade.vertex_light(turned, albedo)
        return rasterize.draw(positions, triangles, light, camera, behind)

    return paint
