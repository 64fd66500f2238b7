"""Glue 102 markers to Mia's skin and follow them."""

from typing import NamedTuple

import numpy as np

from data_example.generator import actor as actors
from data_example.generator import mia, skin

PREFIX = "mia:"
# how far a marker's middle stands off the skin [mm]
HEIGHT = 1.7
# places in the frontal plane of Ada's proportions [mm], on the middle line and on her left side
MIDDLE = {
    "MFH1": (0, 54), "MFH2": (0, 39), "GLAB": (0, 24), "MNOS1": (0, 11), "MNOS2": (0, -8),
    "MNOS3": (0, -23), "MNOS4": (0, -38), "MUPH": (0, -57), "MULP": (0, -67), "MLLP": (0, -75.5),
    "MLCH": (0, -84.5), "MCHN1": (0, -93), "MCHN2": (0, -102), "MCHN3": (0, -109),
}  # fmt: skip
SIDE = {
    "FHD1": (14, 53), "FHD2": (28, 49), "FHD3": (15, 39), "FHD4": (33, 39),
    "BRO1": (15, 24.5), "BRO2": (23.5, 27), "BRO3": (32.5, 29), "BRO4": (42, 28.6),
    "BRO5": (51, 25), "TMP1": (60, 15), "TMP2": (63, -3), "ULID": (31.5, 10.3), "ECO": (54, 1),
    "LLD1": (21, -14), "LLD2": (32, -16.5), "LLD3": (44, -14), "NSD": (11, -28),
    "NWN": (13, -44), "CHK1": (24, -27), "CHK2": (36, -29), "CHK3": (50, -25),
    "CHK4": (28, -40), "CHK5": (40, -42), "CHK6": (54, -40), "CHK7": (38, -56),
    "CHK8": (51, -57), "CHK9": (43, -71), "NLF1": (19, -49), "NLF2": (27, -56),
    "NLF3": (34, -67), "UPH1": (8, -57.5), "UPH2": (17, -60), "ULP1": (8, -66.5),
    "ULP2": (17, -67.2), "MTH": (28.5, -68.4), "LLP1": (8, -75), "LLP2": (17, -73.2),
    "LCH1": (10, -84), "LCH2": (21, -81.5), "CHN": (12, -101), "JAW1": (21, -95),
    "JAW2": (32, -87), "JAW3": (42, -79), "JAW4": (55, -66),
}  # fmt: skip
NAMES = (*MIDDLE, *(side + name for name in SIDE for side in "RL"))


class Glued(NamedTuple):
    """Where the markers sit on the skin.

    corners : (102, 3) int array, the skin's vertices round each marker
    shares : (102, 3) float array, their parts in its place
    """

    corners: np.ndarray
    shares: np.ndarray


def _places(rng):
    """Return where a person glued the markers, in the frontal plane, (102, 2) [mm]."""
    places = [np.array(MIDDLE[name], float) for name in MIDDLE]
    places += [np.array(SIDE[name]) * [out, 1.0] for name in SIDE for out in (-1, 1)]
    return np.stack(places) + rng.uniform(-0.6, 0.6, (len(places), 2))


def glue(body, seed=17):
    """Glue the markers to what lies foremost at their places in the frontal plane.

    Parameters
    ----------
    body : skin.Skin
    seed : int
        Sets how far they are glued off their places.
    """
    a, b, c = (body.rest[body.faces[:, i]] for i in range(3))
    area = _cross(b - a, c - a)
    rows, shares = [], []
    for place in _places(np.random.default_rng(seed)):
        p = np.append(place, 0.0)
        parts = np.stack([_cross(b - p, c - p), _cross(c - p, a - p), _cross(a - p, b - p)], 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            parts = parts / area[:, None]
        inside = (parts >= -1e-9).all(axis=1) & (np.abs(area) > 1e-6)
        depth = np.where(inside, a[:, 2], -np.inf)
        rows.append(depth.argmax())
        shares.append(parts[rows[-1]])
    return Glued(body.faces[rows], np.stack(shares))


def _cross(u, v):
    """Return the third coordinate of cross products, (N,)."""
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def still(body, glued, p):
    """Return the markers without head motion under expression parameters.

    Returns
    -------
    points : (102, 3) float array [mm]
    normals : (102, 3) float array, directions out of the skin
    """
    corners = mia.proportioned(skin.pose(body, p))[glued.corners]
    on = np.einsum("mk,mkd->md", glued.shares, corners)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return on + HEIGHT * normal, normal


def moved(points, rotations, translations):
    """Return markers under head motion, (T, 102, 3) [mm].

    Parameters
    ----------
    points : (T, 102, 3) float array [mm]
    rotations : (T, 3, 3) float array
    translations : (T, 3) float array [mm]
    """
    turned = np.einsum("tij,tmj->tmi", rotations, points - actors.NECK)
    return turned + actors.NECK + translations[:, None]
