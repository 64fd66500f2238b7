"""Render the actor: perspective camera, key, fill and rim light, highlights, 2 x 2 samples."""

import cv2
import numpy as np

from data_example.generator import actor as actors
from data_example.generator import fields, raster

WIDTH, HEIGHT = 480, 480
SAMPLES = 2
DISTANCE = 900.0
FOCAL = 1.46 * DISTANCE
LOOK_AT = np.array([0.0, -26.0, 0.0])
KEY = np.array([-0.48, 0.52, 0.70])
FILL = np.array([0.75, 0.05, 0.55])
RIM = np.array([0.75, 0.45, -0.55])


def to_camera(points):
    """Return points of the set in the camera's axes: x right, y up, -z ahead [mm]."""
    return points - LOOK_AT - [0, 0, DISTANCE]


def project(points):
    """Return pixels of points of the set, (N, 2) [px], y down, first pixel's centre at 0.5."""
    q = to_camera(points)
    x = WIDTH / 2 - FOCAL * q[..., 0] / q[..., 2]
    y = HEIGHT / 2 + FOCAL * q[..., 1] / q[..., 2]
    return np.stack([x, y], axis=-1)


def backdrop(samples=SAMPLES):
    """Return the empty set, (H, W, 3) float32: a wall with soft light on it."""
    y, x = np.mgrid[: HEIGHT * samples, : WIDTH * samples].astype(np.float32) / (WIDTH * samples)
    glow = np.exp(-(((x - 0.30) / 0.42) ** 2 + ((y - 0.34) / 0.55) ** 2))
    base = np.array([0.23, 0.27, 0.33], np.float32)
    warm = np.array([0.40, 0.42, 0.44], np.float32)
    picture = base + glow[..., None] * warm * 0.62
    panel = fields.smoothstep(0.715, 0.722, x) * 0.06
    return (picture - panel[..., None]).astype(np.float32)


def _light(normal, direction, wrap):
    """Return the light that a surface gets from a direction, wrapped round its edge."""
    unit = direction / np.linalg.norm(direction)
    return np.clip((normal @ unit.astype(np.float32) + wrap) / (1 + wrap), 0, None)


def picture(actor, atlas, vertices, ambient, empty, light=1.0, warmth=0.0):
    """Render one picture.

    Parameters
    ----------
    actor : actors.Actor
    atlas : (A, B, 3) float32 array in 0..1
    vertices : (V, 3) float array after head motion [mm]
    ambient : (V,) float array
    empty : (H, W, 3) float32 array, the set without the actor, at all samples
    light : float, factor on the key light
    warmth : float, shift of the key light to red

    Returns
    -------
    picture : (HEIGHT, WIDTH, 3) float32 array in 0..1
    depth : (H, W) float32 array, distance along the view at all samples [mm]
    """
    normal = actors.normals(actor, vertices)
    ones = np.ones((len(vertices), 1))
    values = [actor.uv, actor.gloss[:, None], normal, actor.colour * ambient[:, None], ones]
    shape = (HEIGHT * SAMPLES, WIDTH * SAMPLES)
    maps, depth = raster.fill(
        to_camera(vertices), actor.faces, np.concatenate(values, axis=1), shape, FOCAL * SAMPLES
    )
    covered = depth < raster.COVERED
    rows, columns = np.flatnonzero(covered.any(1)), np.flatnonzero(covered.any(0))
    box = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    maps, covered = np.ascontiguousarray(maps[box]), covered[box]
    colour = cv2.remap(
        atlas,
        maps[..., 0] - 0.5,
        maps[..., 1] - 0.5,
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )
    gloss, normal, ao = maps[..., 2], maps[..., 3:6], maps[..., 6:9]
    normal = normal / np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), 1e-6)
    key_colour = np.array([1.0 + warmth, 0.96, 0.88 - warmth], np.float32) * np.float32(
        0.93 * light
    )
    key = _light(normal, KEY, 0.28)[..., None] * key_colour
    # light that seeps through skin reddens the edge of the shadow
    key[..., 0] += 0.05 * np.exp(-((key[..., 1] - 0.12) ** 2) / 0.02)
    fill = _light(normal, FILL, 0.5)[..., None] * np.array([0.24, 0.28, 0.35], np.float32)
    rim = _light(normal, RIM, 0.0)[..., None] ** 2 * np.array([0.32, 0.36, 0.42], np.float32)
    sky = (0.27 + 0.09 * normal[..., 1:2]) * np.array([0.95, 1.0, 1.05], np.float32)
    lit = colour * ao * (key + fill + sky) + colour * rim * ao
    halfway = KEY / np.linalg.norm(KEY) + [0, 0, 1]
    facing = _light(normal, halfway, 0.0)
    sharp = np.where(gloss > 0.9, 420.0, 34.0).astype(np.float32)
    highlight = gloss * np.power(facing, sharp) * np.where(gloss > 0.9, 0.95, 0.34) * ao[..., 0]
    lit = lit + highlight[..., None] * np.float32(light)
    whole = empty.copy()
    whole[box] = np.where(covered[..., None], lit, whole[box])
    small = cv2.resize(whole, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
    return np.clip(small, 0, 1).astype(np.float32), depth
