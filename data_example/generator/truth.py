"""Keep the truth of a take beside its film: landmarks, head, expression, opening, occlusion."""

import numpy as np
from scipy.spatial import transform

from data_example.generator import actor, contours, landmarks, params, render


def of_take(take, neutral_brows):
    """Return everything true of a take that needs no rendering.

    Parameters
    ----------
    take : shots.Take
    neutral_brows : dict, from landmarks.brows()

    Returns
    -------
    truth : dict of arrays
        landmarks (T, P, 2) [px];
        expression (T, N); quaternion (T, 4) x, y, z, w; translation (T, 3) [mm]; light (T,);
        opening_mm (T,); opening_px (T,); names of points and parameters; camera
    """
    turns = transform.Rotation.from_quat(take.quaternion).as_matrix()
    flat, opening_mm = [], []
    for row, turn, shift in zip(take.expression, turns, take.translation, strict=True):
        p = params.from_row(row)
        dense = landmarks.in_space(p, neutral_brows)
        world = landmarks.moved(dense, turn, shift)
        flat.append(contours.point_set(landmarks.in_picture(world)))
        opening_mm.append(landmarks.opening(p))
    points = np.stack(flat)
    names = contours.names()
    low, high = names.index("lips_inner_04"), names.index("lips_inner_12")
    return {
        "landmarks": np.round(points, 3).astype(np.float32),
        "expression": np.round(take.expression, 4).astype(np.float32),
        "quaternion": take.quaternion.astype(np.float32),
        "translation": take.translation.astype(np.float32),
        "light": take.light.astype(np.float32),
        "opening_mm": np.array(opening_mm, np.float32),
        "opening_px": np.linalg.norm(points[:, high] - points[:, low], axis=1).astype(np.float32),
        "point_names": np.array(names),
        "parameter_names": np.array(params.NAMES),
        "camera": np.array([render.FOCAL, render.DISTANCE, *render.LOOK_AT], np.float32),
        "pivot": actor.NECK.astype(np.float32),
    }


def save(path, truth):
    """Write the truth as a compressed npz without pickles."""
    np.savez_compressed(path, **truth)
