"""Build and move the actor's skin with its lips and lids."""

from typing import NamedTuple

import numpy as np

from data_example.generator import charts, eyes, fields, mouth, params, sdf

CHART_EXTENT = 222.0
MOUTH_BLEND = np.linspace(0, 1, 9)[1:]
EYE_BLEND = np.linspace(0, 1, 6)[1:]


class Skin(NamedTuple):
    """The actor's skin at rest; ring vertices come first, the lattice last.

    rest : (V, 3) float array [mm]
    faces : (F, 3) int array
    chart : (V, 2) float array, flat map of the whole head [mm]
    red : (V,) float array, 1 on the red of the lips and inside, 0 on skin
    inside : (V,) float array, 0 at the lips' edge, 1 at the throat
    lid : (V,) float array, 1 at the lid's edge, 0 from the crease outwards
    nearest : (V,) float array, position along the lips' outer ring of the nearest point
    near_mouth : (V,) float array, how much the vertex follows the lips
    rings : dict name -> (R, N) int array, vertex numbers of mouth, eye_r, eye_l
    """

    rest: np.ndarray
    faces: np.ndarray
    chart: np.ndarray
    red: np.ndarray
    inside: np.ndarray
    lid: np.ndarray
    nearest: np.ndarray
    near_mouth: np.ndarray
    rings: dict


def _groups():
    """Return the ring groups of mouth and eyes at rest, name -> (R, N, 3) [mm]."""
    zero = params.neutral()
    lips = mouth.rings(zero)
    outline = charts.in_front(sdf.head, charts.oval(mouth.COUNT, (0, -71.0), 39, 23, 15.5))
    blend = charts.patch(sdf.head, lips[-1], outline, MOUTH_BLEND)
    groups = {"mouth": np.concatenate([lips, blend])}
    for side in ("r", "l"):
        lids = eyes.lid_rings(side, zero)
        oval = charts.oval(eyes.COUNT, eyes.CENTRES[side][:2], 21.5, 17.5, 17.0)
        outline = charts.in_front(sdf.head, oval)
        blend = charts.patch(sdf.head, lids[-1], outline, EYE_BLEND)
        groups[f"eye_{side}"] = np.concatenate([lids, blend])
    return groups


def build(seed=1):
    """Build the skin at rest.

    Parameters
    ----------
    seed : int
        Turns the circles of the lattice against each other.

    Returns
    -------
    skin : Skin
    """
    groups = _groups()
    outlines = {name: charts.to_chart(group[-1], sdf.CENTRE) for name, group in groups.items()}
    extent = 2.58 * charts.MM
    lattice = charts.lattice(list(outlines.values()), (2.9, 8.4), extent, 1.4, seed)
    rings, start, places, rest = {}, 0, [], []
    for name, group in groups.items():
        count = group.shape[0] * group.shape[1]
        rings[name] = start + np.arange(count).reshape(group.shape[:2])
        places.append(charts.ring_places(outlines[name], len(group), 0.08).reshape(-1, 2))
        rest.append(group.reshape(-1, 3))
        start += count
    rest = np.concatenate([*rest, charts.around(sdf.head, sdf.CENTRE, lattice)])
    chart = np.concatenate([*places, lattice])
    faces = charts.mesh(list(rings.values()), chart)
    red, inside, lid = (np.zeros(len(rest)) for _ in range(3))
    number = np.arange(len(rings["mouth"]))[:, None]
    red[rings["mouth"]] = np.clip((mouth.OUTER + 0.5 - number) * 2, 0, 1)
    inside[rings["mouth"]] = np.clip((mouth.INNER - number) / mouth.INNER, 0, 1)
    number = np.arange(len(rings["eye_l"]))[:, None]
    for side in ("r", "l"):
        last = len(eyes.LID_RINGS) - 1 - eyes.MARGIN
        lid[rings[f"eye_{side}"]] = np.clip(1 - (number - eyes.MARGIN) / last, 0, 1)
    nearest, distance = charts.follow(rest, groups["mouth"][mouth.OUTER])
    near = np.exp(-((distance / 16.0) ** 2)) * fields.smoothstep(20, 50, rest[:, 2])
    near *= fields.smoothstep(-36, -52, rest[:, 1])
    return Skin(rest, faces, chart, red, inside, lid, nearest, near, rings)


def pose(skin, p):
    """Return the skin's vertices under expression parameters, (V, 3) float array [mm]."""
    zero = params.neutral()
    lips = mouth.rings(p)
    outer_rest = mouth.rings(zero)[mouth.OUTER]
    extra = lips[mouth.OUTER] - outer_rest - fields.skin(outer_rest, p)
    pulled = charts.at_ring(extra, skin.nearest)
    result = skin.rest + fields.skin(skin.rest, p) + skin.near_mouth[:, None] * pulled
    result[skin.rings["mouth"][: len(lips)]] = lips
    for side in ("r", "l"):
        lids = eyes.lid_rings(side, p)
        rings = skin.rings[f"eye_{side}"]
        result[rings[: len(lids)]] = lids
        crease = lids[-1] - eyes.lid_rings(side, zero)[-1]
        for ring, w in zip(rings[len(lids) :], EYE_BLEND, strict=True):
            keep = fields.smoothstep(0, 1, np.array(w))
            moved = result[ring] - skin.rest[ring]
            result[ring] = skin.rest[ring] + keep * moved + (1 - keep) * crease
    return result
