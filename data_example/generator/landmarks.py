"""Give the true contours of the actor's face, in space and in the picture."""

import numpy as np

from data_example.generator import actor, contours, eyes, fields, mouth, render, texture

SIDES = (("r", "right"), ("l", "left"))
# how far a point may lie below what is seen there: contours lie on edges, pupils do not
EDGE_MM, PUPIL_MM = 3.0, 0.5


def brows():
    """Return the neutral middle lines of both brows, side -> (N, 3) [mm]."""
    return {name: texture.brow_curve(side) for side, name in SIDES}


def in_space(p, neutral_brows):
    """Return the dense true contours without head motion, name -> (N, 3) [mm]."""
    inner = mouth.inner_curves(p)
    result = {"lips_outer": mouth.outer_curve(inner, p), "lips_inner": inner}
    for side, name in SIDES:
        line = neutral_brows[name]
        result[f"brow_{name}"] = line + fields.skin(line, p)
        result[f"eye_{name}"] = eyes.lid_rings(side, p)[eyes.MARGIN]
        result[f"pupil_{name}"] = eyes.pupil(side, p)[None]
    return result


def moved(space, rotation, translation):
    """Return contours after head motion, name -> (N, 3) [mm]."""
    return {
        name: (line - actor.NECK) @ rotation.T + actor.NECK + translation
        for name, line in space.items()
    }


def in_picture(world):
    """Return contours in the picture, name -> (N, 2) [px]."""
    return {name: render.project(line) for name, line in world.items()}


def visible(world, depth):
    """Return which points of the point set nothing hides from the camera, (P,) bool.

    Parameters
    ----------
    world : dict name -> (N, 3) float array, contours after head motion [mm]
    depth : (H, W) float32 array, distance of what is seen at all samples [mm]
    """
    points = contours.point_set(world)
    kinds = [[kind] * count for kind, count, _ in contours.POINT_SET.values()]
    single = np.concatenate(kinds) == "point"
    places = np.floor(render.project(points) * render.SAMPLES).astype(int)
    height, width = depth.shape
    inside = ((places >= 0) & (places < [width, height])).all(axis=1)
    x, y = np.clip(places, 1, [width - 2, height - 2]).T
    around = [depth[y + dy, x + dx] for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    edge = np.max(around, axis=0) + EDGE_MM
    behind = -render.to_camera(points)[:, 2]
    return inside & (behind < np.where(single, depth[y, x] + PUPIL_MM, edge))


def opening(p):
    """Return the gap between the lips in the middle of the mouth [mm]."""
    inner = mouth.inner_curves(p)
    low, high = inner[mouth.HALF // 2], inner[mouth.HALF + mouth.HALF // 2]
    return float(np.linalg.norm(high - low))
