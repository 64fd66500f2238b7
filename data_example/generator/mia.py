"""Dress the second actress: Mia, who plays the marker takes, with her hair tied back.

She is modelled like Ada, with other proportions, hair, skin, eyes and clothes.
"""

import numpy as np

from data_example.generator import actor as actors
from data_example.generator import fields, parts, sdf, solids, texture

# her head against Ada's: narrower, a little longer and flatter
SCALE = np.array([0.95, 1.03, 0.98])
SKIN = np.array([0.80, 0.80, 0.82])
HAIR = np.array([0.30, 0.24, 0.20])
SUIT = np.array([0.13, 0.14, 0.17])


def _hair(seed=3):
    """Return her hair, combed back over the head: vertices (V, 3) [mm], faces and strands."""
    d, faces = parts.globe(90, 180)
    flat = d.reshape(-1, 3)
    centre = np.array([0.0, -2.0, -12.0])
    origins = np.tile(centre, (len(flat), 1))
    scalp = solids.trace(sdf.head, origins, flat, 190)
    on = centre + scalp[:, None] * flat
    # the hairline: high over the forehead, down before the ears, back below them
    side = fields.smoothstep(30, 68, np.abs(on[:, 0]))
    line = 62 - 26 * fields.smoothstep(12, 58, np.abs(on[:, 0]))
    front = on[:, 1] - line + side * fields.smoothstep(30, 4, on[:, 2]) * 60
    behind = fields.smoothstep(8, -34, on[:, 2]) * 130
    below = fields.smoothstep(-92, -70, on[:, 1])
    cover = fields.smoothstep(-6, 8, front + behind) * below
    rng = np.random.default_rng(seed)
    around = np.arctan2(on[:, 0], on[:, 1] + 30)
    ridges = sum(np.sin(w * around + rng.uniform(0, 6)) / w**0.5 for w in (23, 37, 59, 83))
    radius = scalp - 5 + cover * (10.5 + 1.1 * ridges)
    strand = np.stack([around / (2 * np.pi) + 0.5, np.arccos(flat[:, 1]) / np.pi], axis=1)
    keep = faces[(cover > 0.02)[faces].any(axis=1)]
    return centre + radius[:, None] * flat, keep, strand


def _bun():
    """Return the bun on top of the back of her head: vertices (V, 3) [mm], faces and strands."""
    d, faces = parts.globe(24, 40)
    flat = d.reshape(-1, 3)
    twist = np.arctan2(flat[:, 0], flat[:, 2]) + 2.0 * flat[:, 1]
    radius = 27 * (1 + 0.035 * np.sin(9 * twist))
    strand = np.stack([(twist / (2 * np.pi)) % 1, flat[:, 1] / 2 + 0.5], axis=1)
    return radius[:, None] * flat * [1.1, 0.85, 1.0] + [0, 116, -42], faces, strand


def hair():
    """Return all of her hair: vertices (V, 3) [mm], faces (F, 3), strands (V, 2)."""
    over, bun = _hair(), _bun()
    faces = np.concatenate([over[1], bun[1] + len(over[0])])
    return np.concatenate([over[0], bun[0]]), faces, np.concatenate([over[2], bun[2]])


def build():
    """Build Mia at rest; her proportions are put on by `pose`.

    Returns
    -------
    actor : actors.Actor
    """
    return actors.build(hair)


def proportioned(points):
    """Return points of Ada's head with Mia's proportions, (..., 3) [mm]."""
    return points * SCALE


def paint(mia):
    """Return her atlas: Ada's in other tones, brown eyes, black hair, a dark suit."""
    atlas = texture.paint(mia, seed=9)
    size, strip = actors.ATLAS, actors.STRIP
    skin = atlas[:size]
    skin[:] = skin**1.12 * SKIN * [1.0, 0.98, 0.93]
    below = atlas[size:]
    iris = below[:, :strip]
    brown = iris.mean(axis=2, keepdims=True) * np.array([1.25, 0.80, 0.50])
    green = np.clip((iris[..., 1:2] - iris[..., :1]) * 6, 0, 1)
    iris[:] = iris + green * (brown - iris)
    locks = below[:, strip : strip + 1040]
    locks[:] = locks.mean(axis=2, keepdims=True) * HAIR * 1.5
    x = int(actors.swatch("clothes")[0])
    below[32:96, x - 30 : x + 30] = SUIT
    x = int(actors.swatch("ear")[0])
    below[32:96, x - 30 : x + 30] *= SKIN
    return np.clip(atlas, 0, 1).astype(np.float32)
