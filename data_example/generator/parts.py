"""Build what is not skin: teeth, tongue, ears, hair, lashes and the pullover."""

import numpy as np

from data_example.generator import charts, eyes, fields, sdf, solids

TEETH = 10
PER_TOOTH = 6


def teeth(upper):
    """Build one row of teeth with its gum.

    Returns
    -------
    vertices : (V, 3) float array [mm]
    faces : (F, 3) int array
    colours : (V, 3) float array
    """
    columns = TEETH * PER_TOOTH + 1
    s = np.linspace(-1, 1, columns)
    widths = np.interp(np.abs(s), [0, 0.2, 0.6, 1], [1.15, 1.05, 0.95, 0.9])
    x = np.cumsum(widths) - np.cumsum(widths)[columns // 2]
    x = 26.5 * x / x[-1]
    within = (np.arange(columns) % PER_TOOTH) / PER_TOOTH
    crown = np.sin(np.pi * within) ** 0.45
    arch = 79.0 - 0.0285 * x * x if upper else 77.0 - 0.031 * x * x
    long = (
        1
        - 0.10 * np.abs(s)
        - 0.06 * (np.abs(s) > 0.2)
        + 0.05 * (np.abs(s) > 0.42) * (np.abs(s) < 0.6)
    )
    rows = np.array([-0.9, -0.35, 0.0, 0.12, 0.45, 0.8, 0.94, 1.0, 0.96])
    back = np.array([-3.0, -0.6, -0.2, 0.3, 0.5, 0.1, -0.5, -1.6, -4.0])
    height = 9.6 if upper else 8.0
    vertices, colours = [], []
    for row, (t, depth) in enumerate(zip(rows, back, strict=True)):
        length = (
            height * t * (1 - (1 - crown) * (0.14 if t > 0.7 else 0.0)) * (long if t > 0 else 1)
        )
        y = -63.4 - length if upper else -80.8 + length
        z = arch + depth + (0.5 * (crown - 1) if t > 0 else 0)
        vertices.append(np.stack([x, y + 0 * x, z], axis=1))
        shade = 0.62 + 0.38 * crown if t > 0.05 else 0.9 + 0 * x
        base = np.array([0.95, 0.92, 0.85]) if row >= 3 else np.array([0.78, 0.38, 0.38])
        colours.append(shade[:, None] * base)
    index = np.arange(len(rows) * columns).reshape(len(rows), columns)
    faces = charts.strip(index, closed=False)
    faces = faces[:, ::-1] if upper else faces
    return np.concatenate(vertices), faces, np.concatenate(colours)


def globe(rows, columns):
    """Return unit directions of a globe with its pole up, (rows, columns, 3), and faces."""
    polar = np.linspace(0.004, np.pi - 0.004, rows)[:, None]
    around = 2 * np.pi * np.arange(columns)[None] / columns
    directions = np.stack(
        [
            np.sin(polar) * np.sin(around),
            np.cos(polar) + 0 * around,
            np.sin(polar) * np.cos(around),
        ],
        -1,
    )
    index = np.arange(rows * columns).reshape(rows, columns)
    return directions, charts.strip(index)[:, ::-1]


def tongue():
    """Build the tongue at rest behind the lower teeth, (V, 3) [mm] and its faces."""
    d, faces = globe(16, 24)
    p = d * [17.0, 6.5, 26.0]
    p[..., 1] -= 1.6 * np.exp(-((p[..., 0] / 4.0) ** 2)) * (d[..., 1] > 0)
    return p.reshape(-1, 3) + np.array([0, -79.0, 47.0]), faces


def pose_tongue(rest, p):
    """Return the tongue, carried by the jaw and lifted at its tip, (V, 3) [mm]."""
    tip = fields.smoothstep(45, 72, rest[:, 2])
    lifted = rest + fields.jaw_motion(rest, p)
    lift = p["tongue_up"] * (3.0 + 17.0 * p["jaw_open"])
    return lifted + (tip * lift)[:, None] * [0, 1.0, 0.18]


def ears():
    """Build both ears as dished ovals, (V, 3) [mm], faces and an ambient shade (V,)."""
    d, faces = globe(26, 26)
    rim = np.hypot(d[..., 1] / 0.92, d[..., 2] / 0.9)
    dish = 4.6 * (1 - fields.smoothstep(0.35, 0.78, rim)) * (d[..., 0] > 0)
    inner = 2.0 * np.exp(-(((rim - 0.62) / 0.09) ** 2)) * (d[..., 0] > 0)
    p = d * [6.5, 28.0, 17.0]
    p[..., 0] += inner - dish
    p[..., 2] *= 1 - 0.32 * fields.smoothstep(0.1, -0.9, d[..., 1])
    turn = np.deg2rad(24)
    x = p[..., 0] * np.cos(turn) - p[..., 2] * np.sin(turn)
    z = p[..., 0] * np.sin(turn) + p[..., 2] * np.cos(turn)
    left = np.stack([x + 74.0, p[..., 1] - 10.0 - 0.1 * z, z - 6.0], -1).reshape(-1, 3)
    shade = (1 - 0.5 * (dish > 1.5)).reshape(-1)
    right = left * [-1, 1, 1]
    count = len(left)
    return (
        np.concatenate([left, right]),
        np.concatenate([faces, faces[:, ::-1] + count]),
        np.concatenate([shade, shade]),
    )


def hair(seed=2):
    """Build the hair with strands as ridges.

    Returns
    -------
    vertices : (V, 3) float array [mm]
    faces : (F, 3) int array
    strand : (V, 2) float array, across and along the strands, 0..1
    """
    rows, columns = 100, 210
    d, faces = globe(rows, columns)
    centre = np.array([0.0, -2.0, -12.0])
    flat = d.reshape(-1, 3)
    origins = np.tile(centre, (len(flat), 1))
    radius = solids.trace(sdf.hair, origins, flat, 190)
    scalp = solids.trace(sdf.head, origins, flat, 190)
    outside = sdf.hair_window(centre + radius[:, None] * flat)
    cover = fields.smoothstep(-5, 9, outside)
    radius = scalp - 6 + cover * (radius - scalp + 6)
    around = np.arctan2(flat[:, 0], flat[:, 2])
    rng = np.random.default_rng(seed)
    ridges = np.zeros(len(flat))
    for wave in (17, 29, 41, 61):
        bend = 0.25 * np.sin(3 * flat[:, 1] + rng.uniform(0, 6))
        ridges += np.sin(wave * (around + bend / 8) + rng.uniform(0, 6)) / wave**0.5
    fade = np.sqrt(np.maximum(1 - flat[:, 1] ** 2, 0))
    vertices = centre + (radius + 3.0 * cover * ridges * fade)[:, None] * flat
    strand = np.stack([around / (2 * np.pi) + 0.5, np.arccos(flat[:, 1]) / np.pi], axis=1)
    # below the skin there is no hair: the mouth, the eyes and the throat lie there
    kept = (outside > -6) & (vertices[:, 1] > -122)
    faces = faces[kept[faces].any(axis=1)]
    return vertices, faces, strand


def clothes():
    """Build the pullover with its collar, (V, 3) [mm] and faces."""
    knots = np.arange(10)
    at = np.linspace(0, 9, 46)
    across = np.interp(at, knots, [40, 45, 51, 54, 57, 76, 122, 172, 196, 200])
    deep = np.interp(at, knots, [40, 45, 51, 54, 57, 62, 68, 74, 78, 80])
    height = np.interp(at, knots, [-168, -146, -146, -164, -186, -196, -206, -224, -260, -340])
    for values in (across, deep, height):
        values[1:-1] = np.convolve(values, [0.25, 0.5, 0.25], "valid")
    around = 2 * np.pi * np.arange(120) / 120
    knit = 1 + 0.006 * np.sin(around * 60)
    vertices = np.stack(
        [
            across[:, None] * np.sin(around) * knit,
            height[:, None] + 0 * around,
            deep[:, None] * np.cos(around) * knit - 24,
        ],
        axis=-1,
    )
    return vertices.reshape(-1, 3), charts.strip(np.arange(46 * 120).reshape(46, 120))[:, ::-1]


def lashes(contour, side):
    """Return the upper lashes as a fan standing on the lid's edge, (2 * N, 3) [mm].

    Parameters
    ----------
    contour : (N, 3) float array, the upper lid's edge from corner to corner [mm]
    side : "l" or "r"
    """
    out = 1.0 if side == "l" else -1.0
    outward = contour - eyes.CENTRES[side]
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    t = np.linspace(-1, 1, len(contour)) * out
    length = 1.2 + 3.4 * fields.smoothstep(-0.9, 0.75, t)
    tips = contour + length[:, None] * (
        0.9 * outward + [0, 0.5, 0] + 0.4 * out * t[:, None] * [1, 0, 0]
    )
    return np.concatenate([contour + 0.5 * outward, tips])
