"""Pictures pulled through maps of the plane. The centre of the first pixel is (0.5, 0.5)."""

import cv2
import numpy as np

COARSE_PX = 4
STIFFNESS = 5.0


def prewarp(image: np.ndarray, to_image: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Cut the face out of a picture with its affine motion undone (CB02 section 3).

    Parameters
    ----------
    image : (H, W, 3) or (H, W) array
    to_image : (2, 3) float array, from the face frame to the picture [px]
    size : width and height of the face frame [px]

    Returns
    -------
    (height, width, ...) array of the picture's type; beyond its border the edge is repeated
    """
    matrix = to_image.copy()
    matrix[:, 2] += matrix[:, :2] @ [0.5, 0.5] - 0.5
    return cv2.warpAffine(
        image,
        matrix,
        size,
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )


def bend(image: np.ndarray, source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Warp a picture so that its source points come to lie on the target points.

    Each pixel is fetched through the thin-plate spline from target to source points, smoothed so
    that points which fall together (closed lids) do not tear the picture. The corners and the
    middles of the picture's sides stay where they are.

    Parameters
    ----------
    image : (H, W, 3) or (H, W) array
    source, target : (P, 2) float array [px]

    Returns
    -------
    array like the image
    """
    height, width = image.shape[:2]
    x, y = np.meshgrid([0.0, width / 2, width], [0.0, height / 2, height])
    anchors = np.delete(np.stack([x.ravel(), y.ravel()], axis=1), 4, axis=0)
    centres = np.concatenate([target, anchors])
    weights = _thin_plate(centres, np.concatenate([source, anchors]))
    x, y = ((np.arange(side // COARSE_PX + 2) - 0.5) * COARSE_PX + 0.5 for side in (width, height))
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    coarse = _bending(places, centres) @ weights[:-3] + weights[-3] + places @ weights[-2:]
    coarse = coarse.reshape(len(y), len(x), 2).astype(np.float32)
    finer = np.array([[1 / COARSE_PX, 0, 0.5], [0, 1 / COARSE_PX, 0.5]])
    fetch = cv2.warpAffine(
        coarse, finer, (width, height), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    )
    return cv2.remap(image, fetch - 0.5, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def _bending(places: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Return `r^2 log r` for every place (N, 2) and centre (M, 2)."""
    square = (places**2).sum(axis=1)[:, None] + (centres**2).sum(axis=1)
    square -= 2 * (places @ centres.T)
    np.maximum(square, 1e-9, out=square)
    return 0.5 * square * np.log(square)


def _thin_plate(centres: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the (M + 3, 2) coefficients of the smoothed spline through values at centres."""
    count = len(centres)
    system = np.zeros((count + 3, count + 3))
    system[:count, :count] = _bending(centres, centres) + STIFFNESS * np.eye(count)
    system[:count, count] = system[count, :count] = 1
    system[:count, count + 1 :] = centres
    system[count + 1 :, :count] = centres.T
    return np.linalg.solve(system, np.concatenate([values, np.zeros((3, 2))]))
