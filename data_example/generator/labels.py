"""Label a dozen frames as a person would: points along the contours, a little off."""

import numpy as np
from scipy.spatial import transform

from data_example.generator import contours, landmarks, params

FRAMES = {"rom": (3, 43, 76, 94, 124, 163, 272, 358), "talk": (125, 218), "turn": (70, 85)}
NOISE_PX = 0.3


def _fractions(kind, count, rng):
    """Return unevenly spaced fractions along a contour, its ends kept."""
    even = contours.fractions(kind, count)
    step = 1 / max(len(even), 1)
    loose = even + rng.uniform(-0.2, 0.2, len(even)) * step
    loose[0] = 0.0
    if kind == "open":
        loose[-1] = 1.0
    return loose


def frame_labels(dense, rng, noise):
    """Return the labels of one frame.

    Parameters
    ----------
    dense : dict name -> (N, 2) float array, true contours [px]
    rng : numpy generator
    noise : float, how far the points are off [px]

    Returns
    -------
    rows : list of (point name, x, y, corner), corner 1 or blank
    """
    rows = []
    for contour, (kind, _, count) in contours.POINT_SET.items():
        at, back = _fractions(kind, count, rng), _fractions(kind, count, rng)
        points = contours.sample(kind, dense[contour], at, back)
        points = points + noise * rng.standard_normal(points.shape)
        for number, (x, y) in enumerate(points):
            name = contour if kind == "point" else f"{contour}_{number:02d}"
            corner = "1" if kind == "closed" and number % (count // 2) == 0 else ""
            rows.append((name, x, y, corner))
    return rows


def table(drawn, seed, noise=NOISE_PX):
    """Return labels as the text of a labels file.

    Parameters
    ----------
    drawn : iterable of (frame, dict name -> (N, 2) float array, true contours [px])
    seed : int
    noise : float, how far the points are off [px]
    """
    rng = np.random.default_rng(seed)
    lines = ["frame,point,x_px,y_px,corner"]
    for frame, dense in drawn:
        for name, x, y, corner in frame_labels(dense, rng, noise):
            lines.append(f"{frame},{name},{x:.2f},{y:.2f},{corner}")
    return "\n".join(lines) + "\n"


def of_take(take, frames, neutral_brows, seed=31):
    """Return the labels of a take's frames as the text of a labels file."""
    drawn = []
    for frame in frames:
        p = params.from_row(take.expression[frame])
        turn = transform.Rotation.from_quat(take.quaternion[frame]).as_matrix()
        dense = landmarks.in_space(p, neutral_brows)
        world = landmarks.moved(dense, turn, take.translation[frame])
        drawn.append((frame, landmarks.in_picture(world)))
    return table(drawn, seed)
