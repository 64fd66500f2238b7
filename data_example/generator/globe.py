"""Put the planet together: four mouths and five eyes on a sphere, in centimetres, facing +z."""

import numpy as np

from data_example.generator import (
    acting,
    extreme_files,
    globe_body,
    globe_features,
    globe_grid,
    modelling,
)

RADIUS = 12.0
LIPS = {
    "mouth_grand": ((0.86, 0.30, 0.28), (0.93, 0.42, 0.36)),
    "mouth_askew": ((0.76, 0.26, 0.48), (0.86, 0.38, 0.56)),
    "mouth_sleepy": ((0.60, 0.40, 0.70), (0.72, 0.52, 0.80)),
    "mouth_prim": ((0.94, 0.50, 0.20), (0.98, 0.64, 0.32)),
}
DARK, THROAT = (0.30, 0.05, 0.08), (0.10, 0.02, 0.04)
TEETH, TONGUE = (0.97, 0.95, 0.88), (0.80, 0.36, 0.40)
IRIS = {
    "eye_moon": (0.25, 0.60, 0.35),
    "eye_middle": (0.75, 0.48, 0.14),
    "eye_north": (0.50, 0.34, 0.70),
    "eye_east": (0.20, 0.50, 0.75),
    "eye_south": (0.72, 0.26, 0.22),
}
LID = {
    "eye_moon": (0.95, 0.80, 0.45),
    "eye_middle": (0.93, 0.66, 0.50),
    "eye_north": (0.62, 0.80, 0.70),
    "eye_east": (0.86, 0.70, 0.80),
    "eye_south": (0.94, 0.86, 0.60),
}
WHITE, PUPIL = (0.98, 0.98, 0.95), (0.04, 0.03, 0.05)
ROW = {"unit": "cm", "up_axis": "y", "pivot": "0 0 0", "face_unit": "10"}
# how far the skin goes along with the border of a mouth and of an eye, and how far it reaches
PULL = {"mouth": 0.62, "eye": 0.4}
REACH = 0.16
# what a border belongs to its feature, so that lids and lips stay on their ground
SEAM = 0.8


def zipper(ring):
    """Return quads that close a ring of an even number of vertices from side to side."""
    return [(ring[i], ring[i + 1], ring[-i - 2], ring[-i - 1]) for i in range(len(ring) // 2 - 1)]


class Globe:
    """The planet at rest, with everything that its poses need."""

    def __init__(self):
        self.skin = globe_body.Skin()
        self.parts = modelling.Pieces()
        grid = self.skin.grid
        self.parts.add("skin", len(grid.directions), grid.faces, self.skin.colours())
        for name in globe_features.MOUTHS:
            self._add_mouth(name)
        for name in globe_features.EYES:
            self._add_eye(name)
        self.anchors = self._anchors(acting.neutral())
        borders = np.concatenate([grid.borders[name] for name in globe_grid.SITES])
        self.pull = self._near(borders, REACH)
        self.seam = SEAM * self._near(borders, 1.5 * REACH)

    def _near(self, borders, reach):
        """Return how much each vertex of the skin has of each of a border, (V, B), sums of 0..1."""
        directions = self.skin.grid.directions
        off = np.linalg.norm(directions[:, None] - directions[borders], axis=2)
        near = np.exp(-((off / reach) ** 2))
        near[borders] = np.eye(len(borders))
        return near / np.maximum(near.sum(axis=1, keepdims=True), 1.0)

    def _sew(self, name, first, count):
        """Join a feature's outer ring, its first vertices, to its border in the skin."""
        border = self.skin.grid.borders[name]
        for i in range(count):
            j = (i + 1) % count
            self.parts.faces.append((int(border[i]), int(border[j]), first + j, first + i))

    def _add_mouth(self, name):
        """Add a mouth: lips and throat, teeth, tongue."""
        count = len(self.skin.grid.borders[name])
        outer, middle = LIPS[name]
        tones = np.repeat([outer, middle, DARK, THROAT], count, axis=0)
        self._sew(name, self.parts.count, count)
        faces = modelling.grid(4, count, closed=True) + zipper(range(3 * count, 4 * count))
        self.parts.add(name, 4 * count, faces, tones)
        teeth = modelling.grid(2, globe_features.TEETH)
        self.parts.add(f"teeth_{name}", 2 * globe_features.TEETH, teeth, TEETH)
        self.parts.add(f"tongue_{name}", 9, modelling.flipped(modelling.grid(3, 3)), TONGUE)

    def _add_eye(self, name):
        """Add an eye: lids and ball."""
        count, spokes = len(self.skin.grid.borders[name]), globe_features.SPOKES[name]
        lid = np.array(LID[name])
        tones = np.repeat([0.85 * lid, lid, 0.55 * lid], count, axis=0)
        self._sew(name, self.parts.count, count)
        self.parts.add(name, 3 * count, modelling.grid(3, count, closed=True), tones)
        rows = len(globe_features.BALL_RINGS)
        faces = modelling.flipped(modelling.grid(rows, spokes, closed=True))
        faces += zipper(range(spokes))
        iris = np.array(IRIS[name])
        tones = np.repeat([PUPIL, iris, 0.6 * iris, WHITE, WHITE, WHITE], spokes, axis=0)
        faces.append(tuple(rows * spokes + k for k in range(4)))
        tones = np.concatenate([tones, np.ones((4, 3))])
        self.parts.add(f"ball_{name}", len(tones), faces, tones)

    def _anchors(self, p):
        """Return what the features' outer rings do to the borders of the skin, (B, 3)."""
        rows = []
        for name in globe_grid.SITES:
            count = len(self.skin.grid.borders[name])
            placed = globe_features.placed_mouth if "mouth" in name else globe_features.placed_eye
            rows.append(PULL[name.split("_")[0]] * placed(name, p)[0][:count])
        return np.concatenate(rows)

    def pose(self, p, body):
        """Return all vertices of a pose, (V, 3) [cm]."""
        skin = self.skin.points(body, p["upper_up"])
        pieces = [skin + self.pull @ (self._anchors(p) - self.anchors)]
        for name in globe_features.MOUTHS:
            pieces += globe_features.placed_mouth(name, p)
        for name in globe_features.EYES:
            pieces += globe_features.placed_eye(name, p)
        return RADIUS * globe_body.warp(np.concatenate(pieces), body)

    def masks(self):
        """Return how much upper, mouth and eyes have of each vertex, (3, V), sums of one."""
        result = np.zeros((3, self.parts.count))
        result[1, self.parts.numbers("mouth", "teeth", "tongue")] = 1.0
        result[2, self.parts.numbers("eye", "ball")] = 1.0
        is_mouth = np.concatenate(
            [np.full(len(b), "mouth" in name) for name, b in self.skin.grid.borders.items()]
        )
        near = np.arange(len(self.skin.grid.directions))
        for row, mine in ((1, is_mouth), (2, ~is_mouth)):
            result[row, near] = np.round(self.seam[:, mine].sum(axis=1), 2)
        result[0] = 1 - result[1] - result[2]
        return np.round(result, 2)


def poses(globe):
    """Return every extreme's vertices, `<layer>_<name>` -> (V, 3) [cm]."""
    emotions = acting.bodies(globe_body.BODIES, globe_body.REST)
    return {
        f"{layer}_{name}": globe.pose(p, emotions.get(name, globe_body.REST))
        for (layer, name), p in acting.faces().items()
    }


def build():
    """Return the planet, ready to write."""
    globe = Globe()
    neutral = globe.pose(acting.neutral(), globe_body.REST)
    faces, colours = np.array(globe.parts.faces), np.concatenate(globe.parts.colours)
    masks = globe.masks()
    return extreme_files.Played("globe", neutral, poses(globe), faces, colours, masks, 4, ROW)
