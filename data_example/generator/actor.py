"""Put the actor together: one mesh of skin, eyeballs, teeth, tongue, ears, hair and clothes."""

from typing import NamedTuple

import numpy as np
from scipy import sparse

from data_example.generator import charts, eyes, fields, mouth, occlusion, params, parts, skin

NECK = np.array([0.0, -140.0, -22.0])
UPPER_LID = np.arange(eyes.HALF, eyes.COUNT + 1) % eyes.COUNT
# rows of the atlas below the skin's square; fractions of its width
ATLAS = 2048
STRIP = 512
SWATCHES = {
    "gum": (0.78, 0.38, 0.38),
    "tongue": (0.80, 0.36, 0.38),
    "lash": (0.07, 0.045, 0.04),
    "ear": (0.93, 0.66, 0.55),
    "clothes": (0.16, 0.36, 0.38),
    "caruncle": (0.85, 0.50, 0.46),
}


class Actor(NamedTuple):
    """The actor at rest; arrays over all vertices in the order of the parts.

    uv : (V, 2) float array, place in the atlas [px]
    faces : (F, 3) int array
    colour : (V, 3) float array, factor on the atlas
    gloss : (V,) float array, strength of the highlight
    ambient : (V,) float array, light that reaches the vertex, 0..1
    neck : (V,) float array, 1 for the head, 0 for what the neck leaves behind
    sums : (V, F) sparse array, adds the normals of faces round a vertex
    """

    skin: skin.Skin
    rest: dict
    slices: dict
    uv: np.ndarray
    faces: np.ndarray
    colour: np.ndarray
    gloss: np.ndarray
    ambient: np.ndarray
    neck: np.ndarray
    sums: sparse.csr_array


def swatch(name):
    """Return the middle of a one-colour field of the atlas, (2,) [px]."""
    return np.array([1600.0 + 64 * list(SWATCHES).index(name), ATLAS + 64.0])


def _parts(hair):
    """Return vertices, faces, uv, colour, gloss and ambient of every part at rest."""
    body = skin.build()
    chart_uv = (body.chart * [1, -1] / (2 * skin.CHART_EXTENT) + 0.5) * ATLAS
    gloss = 0.16 + 0.34 * body.red + 0.1 * body.lid
    ambient = 1 - 0.93 * fields.smoothstep(0.1, 0.75, body.inside)
    result = {"skin": (body.rest, body.faces, chart_uv, 1.0, gloss, ambient)}
    ball, ball_faces, polar = eyes.ball()
    radius = 250 / 1.9 * polar[:, :1]
    around = np.concatenate([np.cos(polar[:, 1:]), -np.sin(polar[:, 1:])], axis=1)
    ball_uv = [256, ATLAS + 256] + radius * around
    for side in ("r", "l"):
        result[f"ball_{side}"] = (ball, ball_faces, ball_uv, 1.0, 1.0, 1.0)
    white = np.array([1900.0, ATLAS + 400.0])
    for name in ("upper", "lower"):
        vertices, faces, colour = parts.teeth(name == "upper")
        result[name] = (vertices, faces, white, colour, 0.7, 1.0)
    vertices, faces = parts.tongue()
    result["tongue"] = (vertices, faces, swatch("tongue"), 1.0, 0.35, 0.6)
    vertices, faces, shade = parts.ears()
    result["ears"] = (vertices, faces, swatch("ear"), 1.0, 0.12, shade)
    vertices, faces, strand = hair()
    hair_uv = [520, ATLAS + 4] + strand * [1000, 500]
    result["hair"] = (vertices, faces, hair_uv, 1.0, 0.35, 1.0)
    vertices, faces = parts.clothes()
    result["clothes"] = (vertices, faces, swatch("clothes"), 1.0, 0.02, 1.0)
    for side in ("r", "l"):
        count = len(UPPER_LID)
        faces = charts.strip(np.arange(2 * count).reshape(2, count), closed=False)
        result[f"lashes_{side}"] = (np.zeros((2 * count, 3)), faces, swatch("lash"), 1.0, 0.0, 0.7)
    return body, result


def build(hair=parts.hair):
    """Build the actor at rest.

    Parameters
    ----------
    hair : function that gives vertices (V, 3) [mm], faces (F, 3) and strands (V, 2)

    Returns
    -------
    actor : Actor
    """
    body, pieces = _parts(hair)
    slices, start, faces, columns = {}, 0, [], []
    for name, (vertices, triangles, uv, colour, gloss, ambient) in pieces.items():
        count = len(vertices)
        slices[name] = slice(start, start + count)
        faces.append(triangles + start)
        full = [np.broadcast_to(v, (count, w)) for v, w in ((uv, 2), (colour, 3))]
        full += [np.broadcast_to(np.reshape(v, (-1, 1)), (count, 1)) for v in (gloss, ambient)]
        columns.append(np.concatenate(full, axis=1))
        start += count
    table, faces = np.concatenate(columns), np.concatenate(faces)
    rest = {name: piece[0] for name, piece in pieces.items()}
    everything = np.concatenate(list(rest.values()))
    neck = fields.smoothstep(-205, -120, everything[:, 1])
    neck[slices["clothes"]] = 0.0
    for name in ("hair", "ears"):
        neck[slices[name]] = 1.0
    for side in ("r", "l"):
        neck[slices[f"ball_{side}"]] = neck[slices[f"lashes_{side}"]] = 1.0
    number = np.repeat(np.arange(len(faces)), 3)
    sums = sparse.csr_array((np.ones(faces.size), (faces.ravel(), number)), (start, len(faces)))
    ada = Actor(
        body, rest, slices, table[:, :2], faces, table[:, 2:5], table[:, 5], table[:, 6], neck, sums
    )
    return ada._replace(ambient=ada.ambient * _reaching(ada))


def _reaching(ada):
    """Return the light that reaches skin, ears, hair and clothes past each other, (V,)."""
    still = pose(ada, params.neutral())
    sky = occlusion.ambient(still, ada.faces, normals(ada, still), np.array([0.0, -30.0, 0.0]))
    neighbours = ada.sums @ (sky[ada.faces].mean(axis=1))
    sky = neighbours / np.maximum(ada.sums.sum(axis=1), 1)
    result = np.ones(len(sky))
    for name in ("skin", "ears", "hair", "clothes"):
        result[ada.slices[name]] = 0.38 + 0.62 * sky[ada.slices[name]]
    mobile = np.maximum(ada.skin.red, ada.skin.lid > 0)
    rows = ada.slices["skin"]
    result[rows] += mobile * (np.maximum(result[rows], 0.85) - result[rows])
    result[rows][ada.skin.inside > 0] = 1.0
    return result


def pose(actor, p):
    """Return all vertices under expression parameters, without head motion, (V, 3) [mm]."""
    surface = skin.pose(actor.skin, p)
    pieces = dict(actor.rest)
    pieces["skin"] = surface
    axes = eyes.gaze_axes(p)
    for side in ("r", "l"):
        pieces[f"ball_{side}"] = eyes.CENTRES[side] + actor.rest[f"ball_{side}"] @ axes.T
        lids = eyes.lid_rings(side, p)
        pieces[f"lashes_{side}"] = parts.lashes(lids[eyes.MARGIN][UPPER_LID], side)
    pieces["lower"] = actor.rest["lower"] + fields.jaw_motion(actor.rest["lower"], p)
    pieces["tongue"] = parts.pose_tongue(actor.rest["tongue"], p)
    return np.concatenate([pieces[name] for name in actor.slices])


def shade(actor, vertices, p):
    """Return the ambient light of every vertex: what lids, lips and depth leave of it, (V,)."""
    ambient = actor.ambient.copy()
    for side in ("r", "l"):
        azimuth, edge, _, _ = eyes.lid_angles(side, p)
        rows = actor.slices[f"ball_{side}"]
        d = (vertices[rows] - eyes.CENTRES[side]) / eyes.RADIUS
        a = np.arctan2(d[:, 0], d[:, 2])
        upper = np.interp(a, azimuth[UPPER_LID][::-1], edge[UPPER_LID][::-1])
        lower = np.interp(a, azimuth[: eyes.HALF + 1], edge[: eyes.HALF + 1])
        e = np.arcsin(np.clip(d[:, 1], -1, 1))
        under = fields.smoothstep(-0.02, 0.26, upper - e) * fields.smoothstep(
            -0.03, 0.12, e - lower
        )
        side_dark = 1 - 0.35 * fields.smoothstep(0.6, 0.95, np.abs(a) / eyes.CORNER)
        ambient[rows] = (0.45 + 0.55 * under) * side_dark
    inner = mouth.inner_curves(p)
    gap = inner[0 : mouth.HALF + 1, 1].min(), inner[mouth.HALF :, 1].max()
    for name, strength in (("upper", 0.4), ("lower", 0.6), ("tongue", 0.75)):
        rows = actor.slices[name]
        v = vertices[rows]
        depth = fields.smoothstep(30, 84, v[:, 2] + 0.02 * v[:, 0] ** 2)
        hidden = fields.smoothstep(0, 9, gap[1] + 1 - v[:, 1]) if name == "upper" else 1
        across = 1 - 0.5 * fields.smoothstep(10, 27, np.abs(v[:, 0]))
        open_ = 0.55 + 0.45 * fields.smoothstep(1, 12, gap[1] - gap[0])
        ambient[rows] *= (1 - strength + strength * depth * hidden) * across * open_
    return ambient


def normals(actor, vertices):
    """Return unit normals of the vertices, weighted by the areas round them, (V, 3)."""
    a, b, c = (vertices[actor.faces[:, i]] for i in range(3))
    total = actor.sums @ np.cross(b - a, c - a)
    return total / np.maximum(np.linalg.norm(total, axis=1), 1e-12)[:, None]


def move(actor, vertices, rotation, translation):
    """Return vertices under head motion; the neck follows in part, the body a little.

    Parameters
    ----------
    vertices : (V, 3) float array [mm]
    rotation : (3, 3) float array
    translation : (3,) float array [mm]
    """
    turned = (vertices - NECK) @ rotation.T + NECK + translation
    body = vertices + translation * [0.75, 0.75, 1.0]
    return body + actor.neck[:, None] * (turned - body)
