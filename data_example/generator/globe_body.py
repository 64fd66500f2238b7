"""Shape the planet's body: seas, continents, two noses, and what an emotion does to all of it."""

import numpy as np

from data_example.generator import fields, globe_grid

# what the body is in the neutral: heights, widths and angles as shares of the planet
REST = {
    "tall": 1.0, "wide": 1.0, "deep": 1.0, "pear": 0.0, "waist": 0.0, "bend": 0.0, "nod": 0.0,
    "twist": 0.0, "hop": 0.0, "pole": 0.0, "spikes": 0.0, "relief": 1.0, "sag": 0.0,
}  # fmt: skip
BODIES = {
    "serenity": "tall=0.97 wide=1.03 deep=1.02 nod=-0.08 relief=0.6",
    "joy": "tall=1.13 wide=1.0 deep=1.0 hop=0.07 pear=-0.07 bend=0.1 relief=1.3",
    "ecstasy": "tall=1.3 wide=0.95 deep=0.95 hop=0.14 nod=-0.2 pear=-0.12 pole=0.16 relief=1.6",
    "trust": "tall=1.02 wide=1.05 deep=1.06 nod=0.14 bend=-0.12 pear=0.05",
    "fear": "tall=0.98 wide=0.8 deep=0.84 nod=-0.14 pear=-0.14 twist=0.14 spikes=0.035 waist=0.05",
    "surprise": "tall=1.24 wide=1.0 deep=1.02 hop=0.06 nod=-0.06 pear=-0.08",
    "amazement": "tall=1.22 wide=1.22 deep=1.18 hop=0.05 nod=-0.14 relief=0.4",
    "sadness": "tall=0.9 wide=0.97 deep=0.96 pear=0.25 nod=0.16 sag=0.1",
    "grief": "tall=0.85 wide=0.96 deep=0.95 pear=0.31 nod=0.18 sag=0.14 bend=0.1 relief=0.5",
    "disgust": "tall=1.0 wide=0.95 deep=0.92 bend=-0.26 twist=0.24 nod=-0.08 waist=0.1",
    "anger": "tall=0.86 wide=1.1 deep=1.06 nod=0.12 spikes=0.075 relief=1.8",
    "rage": "tall=0.92 wide=1.18 deep=1.14 nod=0.08 spikes=0.16 relief=2.6 waist=-0.06",
    "anticipation": "tall=1.1 wide=0.96 deep=0.98 nod=0.12 bend=0.2 twist=-0.18 pole=0.05",
    "contempt": "tall=1.04 wide=0.97 bend=-0.12 nod=-0.16 twist=0.2 pear=-0.05",
}
HEIGHT = 0.045
WAVES, SEED = 14, 31
NOSES = (((4, -10), 0.125, 0.25), ((51, -1), 0.11, 0.13))
SEA, SHALLOW = (0.10, 0.33, 0.62), (0.22, 0.58, 0.76)
GRASS, SAND, ROCK, ICE = (0.36, 0.62, 0.26), (0.86, 0.74, 0.44), (0.55, 0.40, 0.28), (0.94, 0.97, 1)
NOSE = (0.93, 0.56, 0.44)


def _land(directions, seed=SEED):
    """Return how high the ground is, about -1 to 1, sea below 0, (V,)."""
    rng = np.random.default_rng(seed)
    total = np.zeros(len(directions))
    for _ in range(WAVES):
        way = rng.normal(size=3)
        count = rng.uniform(2.0, 4.2)
        turned = directions @ (way / np.linalg.norm(way))
        total += np.sin(count * turned + rng.uniform(0, 2 * np.pi)) / count
    return total / total.std() * 0.6 - 0.08


def _noses(directions):
    """Return how much of a nose is at directions, a row for each nose, (2, V)."""
    rows = []
    for (lon, lat), width, _ in NOSES:
        site = globe_grid.Site((0, 0, 0, 0), (lon, lat), (0, 0), 0)
        off = 1 - directions @ globe_grid.axes(site)[:, 2]
        rows.append(np.exp(-2 * off / width**2))
    return np.stack(rows)


class Skin:
    """The skin at rest: grid, ground, colours, and how near each vertex is to the features."""

    def __init__(self):
        self.grid = globe_grid.build()
        d = self.grid.directions
        borders = np.concatenate(list(self.grid.borders.values()))
        near = np.arccos(np.clip(d @ d[borders].T, -1, 1)).min(axis=1)
        self.free = fields.smoothstep(0.02, 0.3, near)
        self.land = _land(d)
        self.noses = _noses(d)
        self.height = HEIGHT * np.clip(self.land, -0.25, 1.0) * (0.25 + 0.75 * self.free)
        self.peaks = self.grid.peaks * self.free

    def colours(self):
        """Return the colours of the skin, (V, 3)."""
        stops = [-1.0, -0.1, -0.02, 0.02, 0.12, 0.5, 1.0]
        tones = [SEA, SHALLOW, SAND, SAND, GRASS, GRASS, ROCK]
        base = np.stack([np.interp(self.land, stops, c) for c in np.transpose(tones)], axis=1)
        cold = fields.smoothstep(0.86, 0.94, np.abs(self.grid.directions[:, 1]))[:, None]
        base = base + cold * (np.array(ICE) - base)
        nose = np.clip(1.5 * self.noses.max(axis=0), 0, 1)[:, None]
        return base + nose * (np.array(NOSE) - base)

    def points(self, body, sneer):
        """Return the skin round and unwarped, with its relief, (V, 3) in radii."""
        spikes = body["spikes"] * (2 * self.peaks - 0.3 * self.free)
        radius = 1 + body["relief"] * self.height + spikes
        for nose, (_, _, long) in zip(self.noses, NOSES, strict=True):
            radius = radius + long * nose * (1 + 0.3 * sneer)
        return radius[:, None] * self.grid.directions


def _turn(points, axis, angle):
    """Turn points about an axis by angles of their own, (N, 3)."""
    a, b = [k for k in range(3) if k != axis]
    c, s = np.cos(angle), np.sin(angle)
    result = points.copy()
    result[:, a] = c * points[:, a] - s * points[:, b]
    result[:, b] = s * points[:, a] + c * points[:, b]
    return result


def warp(points, body):
    """Squash, stretch, bend and lift whatever stands on the planet, (N, 3) in radii."""
    y = np.clip(points[:, 1], -1.3, 1.3)
    girth = 1 - body["pear"] * np.sin(0.5 * np.pi * np.clip(y, -1, 1))
    girth = girth - body["waist"] * np.exp(-((y / 0.4) ** 2))
    sizes = (girth * body["wide"], 0 * y + body["tall"], girth * body["deep"])
    result = points * np.column_stack(sizes)
    result[:, 1] += body["pole"] * fields.smoothstep(0.6, 1.05, y) * 1.6
    result[:, 1] -= body["sag"] * (1 - 0.5 * fields.smoothstep(-1.0, 0.6, y))
    # the south pole turns less than the north pole
    share = 0.65 + 0.35 * y
    for axis, word, sign in ((1, "twist", -1), (2, "bend", -1), (0, "nod", 1)):
        result = _turn(result, axis, sign * body[word] * share)
    result[:, 1] += body["hop"]
    return result
