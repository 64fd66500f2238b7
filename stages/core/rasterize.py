"""Pictures of meshes by OpenCV's rasteriser on the processor: no display, no graphics card."""

import dataclasses

import cv2
import numpy as np

FIELD_OF_VIEW = np.deg2rad(22.0)
MARGIN = 1.08
# a difference in brightness between neighbours, of 255, that is an edge, to be smoothed
EDGE_STEP = 16
TOP = (0.36, 0.37, 0.40)
BOTTOM = (0.17, 0.17, 0.19)


@dataclasses.dataclass(frozen=True)
class Camera:
    """A camera that does not move.

    Attributes
    ----------
    world_to_camera : (4, 4) float array; the camera looks along -z, y up
    near, far : distances between which things are seen
    """

    world_to_camera: np.ndarray
    near: float
    far: float


def facing_camera(low: np.ndarray, high: np.ndarray, face_axes: np.ndarray) -> Camera:
    """Place a camera before a face so that a box fits a square picture.

    Parameters
    ----------
    low, high : (3,) float arrays, corners of the box
    face_axes : (3, 3) rotation whose columns are the face's left, up and forward directions

    Returns
    -------
    Camera
    """
    rotation = face_axes.T
    corners = np.stack([rotation @ low, rotation @ high])
    half = np.abs(corners[1] - corners[0]) / 2
    reach = max(MARGIN * max(half[0], half[1]) / np.tan(FIELD_OF_VIEW / 2), np.linalg.norm(half))
    distance = reach + half[2]
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = -rotation @ (low + high) / 2 - [0.0, 0.0, distance]
    return Camera(matrix, reach / 2, distance + half[2] + reach)


def backdrop(side: int) -> np.ndarray:
    """Return a neutral (side, side, 3) float32 picture in 0..1, lighter above."""
    share = np.linspace(0.0, 1.0, side)[:, None, None]
    row = (1 - share) * np.array(TOP) + share * np.array(BOTTOM)
    return np.ascontiguousarray(np.broadcast_to(row, (side, side, 3)), np.float32)


def draw(
    vertices: np.ndarray,
    triangles: np.ndarray,
    colours: np.ndarray,
    camera: Camera,
    behind: np.ndarray,
) -> np.ndarray:
    """Draw a mesh over a backdrop with smooth colours, hidden parts hidden and soft edges.

    Inside a surface the colours are smooth by themselves, so only pixels where the brightness
    jumps are blended with their neighbours. That looks much like drawing at twice the size and
    halving it, in a third of the time.

    Parameters
    ----------
    vertices : (V, 3) float32 array
    triangles : (N, 3) int32 array
    colours : (V, 3) float32 array in 0..1
    camera : where it is seen from
    behind : (H, W, 3) float32 array, the backdrop

    Returns
    -------
    (H, W, 3) uint8 array
    """
    picture = behind.copy()
    depth = np.full(picture.shape[:2], camera.far, np.float32)
    settings = cv2.TriangleRasterizeSettings()
    settings.setShadingType(cv2.RASTERIZE_SHADING_SHADED)
    settings.setCullingMode(cv2.RASTERIZE_CULLING_NONE)
    cv2.triangleRasterize(
        vertices,
        triangles,
        colours,
        picture,
        depth,
        camera.world_to_camera,
        FIELD_OF_VIEW,
        camera.near,
        camera.far,
        settings,
    )
    drawn = cv2.convertScaleAbs(picture, alpha=255.0)
    bright = cv2.cvtColor(drawn, cv2.COLOR_RGB2GRAY)
    jumps = cv2.morphologyEx(bright, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8))
    edges = cv2.compare(jumps, EDGE_STEP, cv2.CMP_GT)
    return cv2.copyTo(cv2.GaussianBlur(drawn, (3, 3), 0.7), edges, drawn)
