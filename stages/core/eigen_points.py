"""Eigen-points: one set of eigenvectors for pixels and points (CB02 section 3; Covell & Bregler).

The pixels of a face, pre-warped against its affine motion, and the places of its points are put
into one vector and analysed together. On a new frame the coefficients are found from the pixels
alone, and the eigenvectors' other half says where the points are.
"""

import dataclasses

import cv2
import numpy as np

from stages.core import face_frame, similarity, warp

PIXEL_STEP = 2  # the pixels are taken at half the face frame's resolution
HULL_MARGIN_PX = 8
ROUNDS = 4
STRETCH_DEVIATION = 0.02


@dataclasses.dataclass(frozen=True)
class EigenPoints:
    """A trained model.

    Attributes
    ----------
    mask : (h, w) bool array, the pixels that count
    pixel_mean : (N,) float32 array, normalised light
    point_mean : (P, 2) float array [px of the face frame]
    pixel_basis : (N, C) float32 array
    point_basis : (2 P, C) float array [px of the face frame]
    solver : (C + 6, N) float32 array, from pixels to coefficients and affine motion
    """

    mask: np.ndarray
    pixel_mean: np.ndarray
    point_mean: np.ndarray
    pixel_basis: np.ndarray
    point_basis: np.ndarray
    solver: np.ndarray


def train(
    images: np.ndarray, shapes: np.ndarray, frame: face_frame.FaceFrame, components: int
) -> EigenPoints:
    """Analyse pixels and points of labelled faces together.

    The joint vector is `[p / |p|_rms, q / |q|_rms]`: pixels and points get equal total variance.
    The projection of new pixels minimises `|E_p c - p|^2 / s^2 + c' L^-1 c`, with `L` the
    variances of the components and `s^2` the mean pixel variance that they leave.

    Parameters
    ----------
    images : (N, H, W, 3) uint8 array
    shapes : (N, P, 2) float array [px of those pictures]
    frame : the face frame
    components : greatest number of components

    Raises
    ------
    ValueError
        if there are fewer than three faces
    """
    if len(images) < 3:
        raise ValueError(f"{len(images)} labelled faces are too few: at least 3")
    mask = _mask(frame)
    poses = [similarity.fit_affine(frame.points, shape) for shape in shapes]
    pixels = np.array(
        [_pixels(image, pose, mask) for image, pose in zip(images, poses, strict=True)]
    ).astype(np.float64)
    points = np.array(
        [similarity.unapply(pose, shape).ravel() for pose, shape in zip(poses, shapes, strict=True)]
    )
    pixel_mean, point_mean = pixels.mean(axis=0), points.mean(axis=0)
    p, q = pixels - pixel_mean, points - point_mean
    scales = [np.sqrt((part**2).sum() / len(part)) + 1e-12 for part in (p, q)]
    _, sizes, basis = np.linalg.svd(np.hstack([p / scales[0], q / scales[1]]), full_matrices=False)
    basis = _signed(basis)
    count = min(components, len(images) - 1)
    variance = sizes[:count] ** 2 / len(images)
    pixel_basis = basis[:count, : p.shape[1]].T * scales[0]
    left = p - (np.hstack([p / scales[0], q / scales[1]]) @ basis[:count].T) @ pixel_basis.T
    noise = (left**2).mean() + 1e-6
    return EigenPoints(
        mask,
        pixel_mean.astype(np.float32),
        point_mean.reshape(-1, 2),
        pixel_basis.astype(np.float32),
        basis[:count, p.shape[1] :].T * scales[1],
        _solver(pixel_mean, pixel_basis, variance, noise, mask),
    )


def project(
    model: EigenPoints, frame: face_frame.FaceFrame, image: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, float]:
    """Find the points of a face from its pixels alone, near where it was.

    Gauss-Newton on the affine motion and the coefficients together: each round pre-warps the
    picture, solves the linear system of `train` with the mean face's gradient beside `E_p`, and
    composes the motion.

    Parameters
    ----------
    model : the eigen-points
    frame : their face frame
    image : (H, W, 3) uint8 array
    points : (P, 2) float array [px of the picture], where the face was

    Returns
    -------
    points : (P, 2) float array [px of the picture]
    residual : root mean square of the pixels off the subspace, over that of the mean face
    """
    pose = frame.pose(points)
    count = model.pixel_basis.shape[1]
    for _ in range(ROUNDS):
        difference = _pixels(image, pose, model.mask) - model.pixel_mean
        solution = model.solver @ difference
        step = _affine_step(solution[count:].astype(np.float64), frame)
        pose = similarity.compose(pose, step)
    coefficients = solution[:count]
    difference -= model.pixel_basis @ coefficients
    shape = model.point_mean + (model.point_basis @ coefficients).reshape(-1, 2)
    return similarity.apply(pose, shape), float(np.sqrt((difference**2).mean()))


def _mask(frame: face_frame.FaceFrame) -> np.ndarray:
    """Return which of the coarse pixels lie in the widened hull of the mean shape."""
    hull = cv2.convexHull((frame.points / PIXEL_STEP).astype(np.float32)).astype(np.int32)
    shape = tuple(-(-side // PIXEL_STEP) for side in frame.size[::-1])
    mask = np.zeros(shape, np.uint8)
    cv2.fillConvexPoly(mask, hull, 1)
    side = 2 * HULL_MARGIN_PX // PIXEL_STEP + 1
    return cv2.dilate(mask, np.ones((side, side), np.uint8)).astype(bool)


def _pixels(image: np.ndarray, pose: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """Return the masked light of a pre-warped face, (N,) float32, of mean 0 and variance 1."""
    coarse = pose * [PIXEL_STEP, PIXEL_STEP, 1]
    face = cv2.cvtColor(warp.prewarp(image, coarse, mask.shape[::-1]), cv2.COLOR_RGB2GRAY)
    values = cv2.GaussianBlur(face.astype(np.float32), (3, 3), 0.8)[mask]
    values -= values.mean()
    return values / (values.std() + 1)


def _solver(
    pixel_mean: np.ndarray,
    pixel_basis: np.ndarray,
    variance: np.ndarray,
    noise: float,
    mask: np.ndarray,
) -> np.ndarray:
    """Return the matrix that solves for coefficients and affine motion at once."""
    face = np.zeros(mask.shape)
    face[mask] = pixel_mean
    inner = cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool)
    slope_y, slope_x = (np.where(inner, slope, 0)[mask] for slope in np.gradient(face))
    y, x = (axis[mask] for axis in np.mgrid[: mask.shape[0], : mask.shape[1]] + 0.5)
    x, y = x - mask.shape[1] / 2, y - mask.shape[0] / 2
    motion = [x, y, np.ones_like(x)]
    columns = [-slope * part for slope in (slope_x, slope_y) for part in motion]
    rows = np.hstack([pixel_basis, np.stack(columns, axis=1)])
    normal = rows.T @ rows / noise
    normal[: len(variance), : len(variance)] += np.diag(1 / variance)
    # stretch and shear cost, turning and scaling do not: a + d, b - c are free
    for first, second, sign in ((0, 4, -1), (1, 3, 1)):
        direction = np.zeros(len(normal))
        direction[len(variance) + first], direction[len(variance) + second] = 1, sign
        normal += np.outer(direction, direction) / STRETCH_DEVIATION**2
    return np.linalg.solve(normal, rows.T / noise).astype(np.float32)


def _affine_step(values: np.ndarray, frame: face_frame.FaceFrame) -> np.ndarray:
    """Return the (2, 3) map of the face frame that six solved numbers mean."""
    a, b, x, c, d, y = values
    linear = np.array([[1 + a, b], [c, 1 + d]])
    centre = np.array([-(-side // PIXEL_STEP) * PIXEL_STEP / 2 for side in frame.size])
    shift = np.array([x, y]) * PIXEL_STEP
    return np.hstack([linear, (centre - linear @ centre + shift)[:, None]])


def _signed(basis: np.ndarray) -> np.ndarray:
    """Return the rows with their largest entry positive, so that signs do not depend on LAPACK."""
    largest = np.abs(basis).argmax(axis=1)
    return basis * np.sign(basis[np.arange(len(basis)), largest])[:, None]
