"""Keep the truth of the session `play`: what was planted, what was played, and its landmarks."""

import numpy as np
from scipy.spatial import transform

from data_example.generator import (
    actor,
    capture,
    contours,
    landmarks,
    marker_takes,
    markers,
    mia,
    mouth,
    params,
    play,
    render,
    shots,
)

SCALE = capture.PICTURE / render.WIDTH
# landmarks are kept of every so many pictures
KEPT = 5


def played(name, rate):
    """Return a take of the session at a rate, capture.Played."""
    take = play.TAKES[name]()
    times = np.arange(round(take.frames * rate / play.RATE)) / rate
    return capture.Played(play.expression(name, times), *marker_takes.head(take, times))


def drawn(shown, frames, neutral_brows):
    """Yield the number and the true dense contours [px] of pictures of a film."""
    for frame in frames:
        p = params.from_row(shown.expression[frame])
        turn = transform.Rotation.from_quat(shown.quaternion[frame]).as_matrix()
        dense = landmarks.in_space(p, neutral_brows)
        dense = {contour: mia.proportioned(line) for contour, line in dense.items()}
        world = landmarks.moved(dense, turn, shown.translation[frame])
        picture = landmarks.in_picture(world)
        yield frame, {contour: SCALE * line for contour, line in picture.items()}


def opening(p):
    """Return the gap between Mia's lips in the middle of the mouth [mm]."""
    inner = mia.proportioned(mouth.inner_curves(p))
    low, high = inner[mouth.HALF // 2], inner[mouth.HALF + mouth.HALF // 2]
    return float(np.linalg.norm(high - low))


def of_take(name, body, glued, neutral_brows):
    """Return what is true of a take of the session.

    Parameters
    ----------
    name : str, of the take
    body : skin.Skin
    glued : markers.Glued
    neutral_brows : dict, from landmarks.brows()

    Returns
    -------
    truth : dict of arrays
        for every marker frame: expression (T, N), quaternion (T, 4) x, y, z, w, translation
        (T, 3) [mm], opening_mm (T,), coefficient (T, K) of the extremes, strength (T, 3, 3) of
        the layers on the masks;
        landmarks (F, P, 2) [px] of the pictures landmark_frames;
        poses (K, N) of the extremes, extreme_frame (K,) in `faces`; marker_neutral (102, 3) [mm];
        camera as in truth.of_take, pivot (3,) [mm]; names; phones, their start and end [s]; gaps
    """
    take = play.TAKES[name]()
    every, shown = played(name, play.RATE), played(name, shots.RATE)
    planted = play.layers(name, np.arange(take.frames) / play.RATE)
    frames = np.arange(0, len(shown.expression), KEPT)
    points = [contours.point_set(lines) for _, lines in drawn(shown, frames, neutral_brows)]
    gap = [opening(params.from_row(row)) for row in every.expression]
    at = play.extreme_frames()
    return {
        "expression": np.round(every.expression, 3).astype(np.float16),
        "quaternion": np.round(every.quaternion, 5).astype(np.float32),
        "translation": np.round(every.translation, 3).astype(np.float32),
        "opening_mm": np.round(gap, 3).astype(np.float32),
        "coefficient": np.round(planted.coefficient, 3).astype(np.float16),
        "strength": np.round(planted.strength, 3).astype(np.float16),
        "landmarks": np.round(points, 2).astype(np.float32),
        "landmark_frames": frames.astype(np.int32),
        "poses": play.poses().astype(np.float32),
        "extreme_frame": np.array([at[extreme] for extreme in play.NAMES], np.int32),
        "marker_neutral": markers.still(body, glued, params.neutral())[0].astype(np.float32),
        "camera": np.array([SCALE * render.FOCAL, render.DISTANCE, *render.LOOK_AT], np.float32),
        "pivot": actor.NECK.astype(np.float32),
        "extreme_names": np.array(play.NAMES),
        "mask_names": np.array(play.MASKS),
        "layer_names": np.array(play.LAYERS),
        "parameter_names": np.array(params.NAMES),
        "marker_names": np.array(markers.NAMES),
        "point_names": np.array(contours.names()),
        "phones": np.array([p.name for p in take.phones]),
        "phone_start_s": np.array([p.start for p in take.phones], np.float32),
        "phone_end_s": np.array([p.end for p in take.phones], np.float32),
        "gaps": np.array(take.gaps.strip().splitlines()),
    }
