"""Paint the actor's atlas: skin with freckles, lips, brows; eyes; hair; plain colours."""

import cv2
import numpy as np

from data_example.generator import actor as actors
from data_example.generator import charts, eyes, fields, raster, sdf, skin

BROW = np.array([[-56, 21.5], [-50, 26.0], [-42, 28.6], [-32, 28.2], [-23, 26.0], [-15, 23.5]])
SKIN = np.array([0.90, 0.665, 0.555])


def _noise(rng, size, cell):
    """Return smooth noise of about unit deviation with bumps of the given size [px]."""
    small = rng.standard_normal((max(size // cell, 2) + 2,) * 2).astype(np.float32)
    return cv2.resize(small, (size, size), interpolation=cv2.INTER_CUBIC)


def _blend(picture, colour, amount):
    """Return a picture mixed with a colour by an amount per pixel."""
    return picture + amount[..., None] * (np.asarray(colour, np.float32) - picture)


def brow_curve(side, count=41):
    """Return the neutral middle line of a brow from its outer to its inner end, (count, 3) [mm]."""
    at = np.linspace(0, len(BROW) - 1, count)
    knots = np.arange(len(BROW))
    fit = np.polyfit(knots, BROW, 4)
    line = sum(fit[i][None] * at[:, None] ** (4 - i) for i in range(5))
    x = line[:, 0] if side == "r" else -line[:, 0]
    return charts.in_front(sdf.head, np.stack([x, line[:, 1]], axis=1))


def _to_pixels(points):
    """Return places in the atlas of points on the skin, (N, 2) [px]."""
    return (
        charts.to_chart(points, sdf.CENTRE) * [1, -1] / (2 * skin.CHART_EXTENT) + 0.5
    ) * actors.ATLAS


def _brow_hairs(picture, rng):
    """Return the picture with the hairs of both brows drawn into it."""
    layer = np.zeros(picture.shape[:2], np.float32)
    for side in ("r", "l"):
        out = -1.0 if side == "r" else 1.0
        line = brow_curve(side, 200)
        for _ in range(620):
            t = rng.uniform(0, 1) ** 0.9
            root = line[int(t * 199)]
            thick = np.interp(t, [0, 0.25, 0.7, 0.93, 1], [0.7, 2.2, 3.3, 2.9, 1.0])
            across = rng.normal(0, 0.42) * thick
            lean = np.interp(t, [0, 0.7, 1], [-0.35, 0.25, 0.95])
            length = rng.uniform(3.0, 5.4) * np.interp(t, [0, 1], [0.8, 1.0])
            bend = rng.uniform(-0.1, 0.1)
            steps = np.linspace(0, 1, 5)[:, None]
            xy = np.array([root[0], root[1] + across]) + length * (
                steps * [out * (1.0 - 0.55 * max(lean, 0)), lean]
                + steps**2 * [0, bend - 0.25 * lean]
            )
            on = np.concatenate([xy, np.full((5, 1), root[2])], axis=1)
            places = (_to_pixels(on) * 16).astype(np.int32)
            cv2.polylines(layer, [places], False, float(rng.uniform(0.35, 0.8)), 2, cv2.LINE_AA, 4)
    layer = cv2.GaussianBlur(layer, (0, 0), 0.7)
    soft = cv2.GaussianBlur(layer, (0, 0), 6)
    covered = np.clip(0.82 * layer + 0.55 * soft, 0, 0.93)
    return _blend(picture, (0.20, 0.105, 0.065), covered)


def _skin(actor, rng):
    """Return the skin's square of the atlas, (ATLAS, ATLAS, 3) float32."""
    body = actor.skin
    values = np.concatenate(
        [body.rest, body.red[:, None], body.lid[:, None], body.inside[:, None]], axis=1
    )
    rows = actor.slices["skin"]
    maps = raster.flat(actor.uv[rows], body.faces, values, actors.ATLAS)
    points, red, lid, inside = maps[..., :3], maps[..., 3], maps[..., 4], maps[..., 5]
    mirrored = points * [1, 1, 1]
    mirrored[..., 0] = np.abs(mirrored[..., 0])
    size = actors.ATLAS
    picture = np.ones((size, size, 3), np.float32) * SKIN.astype(np.float32)
    cloud = (
        0.6 * _noise(rng, size, 150) + 0.5 * _noise(rng, size, 60) + 0.35 * _noise(rng, size, 24)
    )
    picture *= 1 + 0.022 * cloud[..., None] * np.array([0.4, 1.0, 1.0], np.float32)
    blush = fields.bell(mirrored, (40, -33, 60), (20, 14, 60))
    blush += 0.75 * fields.bell(mirrored, (0, -38, 100), (13, 11, 18))
    blush += 0.35 * fields.bell(mirrored, (0, -104, 75), (16, 11, 40))
    picture = _blend(picture, (0.86, 0.40, 0.36), 0.34 * np.clip(blush, 0, 1))
    pores = _noise(rng, size, 5) + 0.6 * _noise(rng, size, 3)
    picture *= 1 + 0.016 * pores[..., None]
    picture = _freckles(picture, mirrored, rng)
    shadow = fields.bell(mirrored, (33, 9, 66), (19, 7, 60)) * (1 - red)
    picture = _blend(picture, (0.66, 0.36, 0.33), 0.12 * shadow)
    picture = _blend(
        picture, (0.60, 0.34, 0.32), 0.10 * fields.bell(mirrored, (33, -17, 66), (14, 5, 60))
    )
    lip_lines = _noise(rng, size, 4)
    lips = np.array([0.74, 0.285, 0.285]) * (1 + 0.05 * lip_lines[..., None])
    edge = fields.smoothstep(0.05, 0.9, red)
    picture = picture + edge[..., None] * (lips - picture)
    picture = _blend(picture, (0.42, 0.10, 0.11), fields.smoothstep(0.0, 0.35, inside))
    picture = _blend(
        picture,
        (0.13, 0.07, 0.06),
        0.92 * fields.smoothstep(0.80, 0.93, lid) * (points[..., 1] > -2),
    )
    picture = _blend(
        picture,
        (0.80, 0.45, 0.40),
        0.6 * fields.smoothstep(0.93, 0.985, lid) * (points[..., 1] <= -2),
    )
    crease = fields.bell(lid[..., None], (0.10,), (0.09,)) * (lid > 0) * (points[..., 1] > 2)
    picture = _blend(picture, (0.42, 0.20, 0.17), 0.3 * crease)
    return _brow_hairs(picture.astype(np.float32), rng)


def _freckles(picture, mirrored, rng):
    """Return the skin with freckles on nose, cheeks and forehead and a few moles."""
    size = len(picture)
    chance = fields.bell(mirrored, (22, -24, 70), (34, 17, 70)) + 0.30
    chance *= mirrored[..., 2] > 20
    layer = np.zeros((size, size), np.float32)
    for _ in range(5200):
        x, y = rng.integers(40, size - 40, 2)
        if rng.random() > chance[y, x]:
            continue
        strength = float(rng.uniform(0.14, 0.5) * min(chance[y, x] + 0.25, 1))
        radius = int(rng.uniform(22, 62))
        cv2.circle(layer, (int(x) * 16, int(y) * 16), radius, strength, -1, cv2.LINE_AA, 4)
    layer = cv2.GaussianBlur(layer, (0, 0), 1.2)
    for x, y in ((41, -52), (-30, -86), (-47, -20), (12, 44), (-20, 52)):
        place = _to_pixels(charts.in_front(sdf.head, np.array([[x, y]], float)))[0]
        cv2.circle(layer, tuple(int(v) for v in place), 4, 0.85, -1, cv2.LINE_AA)
    return _blend(picture, (0.50, 0.26, 0.16), layer)


def _eye(rng):
    """Return the eyeball's square of the atlas, (STRIP, STRIP, 3) float32."""
    size = actors.STRIP
    y, x = np.mgrid[:size, :size].astype(np.float32) + 0.5 - size / 2
    angle = np.hypot(x, y) * 1.9 / 250
    around = np.arctan2(y, x)
    iris, pupil = float(eyes.IRIS), float(eyes.PUPIL)
    picture = np.ones((size, size, 3), np.float32) * np.array([0.93, 0.905, 0.89], np.float32)
    picture = _blend(picture, (0.86, 0.62, 0.58), 0.6 * fields.smoothstep(0.55, 1.2, angle))
    fibres = np.zeros_like(angle)
    for wave in (9, 17, 31, 53):
        fibres += (
            np.sin(wave * around + rng.uniform(0, 6) + 2 * angle * rng.uniform(-1, 1)) / wave**0.3
        )
    ring = (angle - pupil) / (iris - pupil)
    colour = np.array([0.20, 0.45, 0.42]) * (1 + 0.16 * fibres[..., None])
    colour = (
        colour
        + (np.array([0.62, 0.50, 0.22]) - colour)
        * (0.75 * fields.smoothstep(0.55, 0.0, ring + 0.06 * fibres))[..., None]
    )
    colour *= (1 - 0.72 * fields.smoothstep(0.70, 1.0, ring))[..., None]
    inside = fields.smoothstep(iris + 0.025, iris - 0.025, angle)
    picture = picture + inside[..., None] * (colour - picture)
    hole = fields.smoothstep(pupil + 0.018, pupil - 0.018, angle)
    return _blend(picture, (0.02, 0.015, 0.015), hole).astype(np.float32)


def _hair(rng):
    """Return the hair's field of the atlas, (STRIP, 1040, 3) float32."""
    coarse = rng.standard_normal((3, 90)).astype(np.float32)
    fine = rng.standard_normal((5, 420)).astype(np.float32)
    shape = (1040, actors.STRIP)
    lines = cv2.resize(coarse, shape, interpolation=cv2.INTER_CUBIC)
    lines = lines + 0.8 * cv2.resize(fine, shape, interpolation=cv2.INTER_LINEAR)
    base = np.array([0.36, 0.145, 0.075], np.float32)
    return (base * np.exp(0.22 * lines)[..., None]).astype(np.float32)


def paint(actor, seed=7):
    """Paint the whole atlas, (ATLAS + STRIP, ATLAS, 3) float32 in 0..1."""
    rng = np.random.default_rng(seed)
    atlas = np.ones((actors.ATLAS + actors.STRIP, actors.ATLAS, 3), np.float32)
    atlas[: actors.ATLAS] = _skin(actor, rng)
    below = atlas[actors.ATLAS :]
    below[:, : actors.STRIP] = _eye(rng)
    below[:, actors.STRIP : actors.STRIP + 1040] = _hair(rng)
    for name, colour in actors.SWATCHES.items():
        x = int(actors.swatch(name)[0])
        below[32:96, x - 30 : x + 30] = colour
    return np.clip(atlas, 0, 1)
