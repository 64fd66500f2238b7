"""Put the cassette player together, in metres: speakers for eyes, the compartment for a mouth."""

import numpy as np

from data_example.generator import (
    acting,
    cassette_body,
    cassette_parts,
    extreme_files,
    fields,
    modelling,
)

SHELL, PANEL, EDGE = (0.80, 0.24, 0.20), (0.93, 0.86, 0.70), (0.30, 0.12, 0.14)
CHROME, DARK, YELLOW = (0.74, 0.77, 0.80), (0.10, 0.09, 0.12), (0.98, 0.76, 0.24)
TEAL, TEAL_DARK = (0.20, 0.58, 0.60), (0.10, 0.34, 0.38)
CONE = ((0.80, 0.79, 0.75), (0.97, 0.96, 0.90), (0.97, 0.96, 0.90), DARK, (0.26, 0.24, 0.30))
CASE = (TEAL_DARK, TEAL_DARK, TEAL, (0.08, 0.20, 0.22), (0.16, 0.06, 0.08))
COLOURS = {
    "handle": EDGE, "aerial": CHROME, "ball": YELLOW, "button": YELLOW, "scale": TEAL_DARK,
    "needle": YELLOW, "keys": (0.97, 0.95, 0.88), "slab": (0.36, 0.30, 0.34), "hub": CHROME,
    "tape": (0.55, 0.28, 0.20), "reel": CHROME, "glint": (1, 1, 1), "brow": EDGE,
}  # fmt: skip
ROW = {"unit": "m", "up_axis": "y", "pivot": "0 -0.105 0", "face_unit": "0.268"}
SCALE = 100.0
SEAM = 0.85


def _bar(half):
    """Return the faces of two ribbons of so many columns, one behind the other."""
    quads = modelling.grid(2, half)
    behind = [tuple(v + 2 * half for v in face) for face in modelling.flipped(quads)]
    sides = ((half, 3 * half), (2 * half, 0))
    return (
        quads
        + behind
        + [(a + i, a + i + 1, b + i + 1, b + i) for a, b in sides for i in range(half - 1)]
    )


def closing(start, count):
    """Return quads that close a ring of vertices from side to side."""
    last = start + count - 1
    return [(start + i, start + i + 1, last - 1 - i, last - i) for i in range(count // 2 - 1)]


def _faces(name, count):
    """Return the faces of a piece."""
    kind = name.split("_")[0].rstrip("0123456789")
    if kind in ("handle", "aerial"):
        return _bar(count // 4)
    if kind in ("hub", "glint"):
        return closing(0, count)
    if kind in ("ball", "button"):
        around = modelling.flipped(modelling.grid(2, 4, closed=True))
        return [*around, (0, 1, 2, 3), (7, 6, 5, 4)]
    if kind in ("mouth", "rim", "cone", "reel"):
        rows = {"mouth": 5, "rim": 3, "cone": 5, "reel": 2}[kind]
        ring = count // rows
        faces = modelling.grid(rows, ring, closed=True)
        return faces + ([] if kind == "rim" else closing(count - ring, ring))
    rows = {"lidup": 3, "lidlow": 3, "tape": 3, "brow": 4}.get(kind, 2)
    faces = modelling.grid(rows, count // rows)
    return modelling.flipped(faces) if kind == "tape" else faces


def _tones(name, count):
    """Return the colours of a piece, (count, 3) or (3,)."""
    rows = {"mouth": CASE, "cone": CONE, "rim": (EDGE, CHROME, EDGE)}
    kind = name.split("_")[0].rstrip("0123456789")
    if kind in rows:
        return np.repeat(rows[kind], count // len(rows[kind]), axis=0)
    if kind in ("lidup", "lidlow"):
        tones = np.repeat([DARK, YELLOW, (0.90, 0.60, 0.16)], count // 3, axis=0)
        return tones if kind == "lidup" else tones[::-1]
    return COLOURS[kind]


class Cassette:
    """The cassette player at rest, with everything that its poses need."""

    def __init__(self):
        panel, box, faces = cassette_body.chassis()
        self.panel, self.box = panel, box
        self.parts = modelling.Pieces()
        grid = modelling.grid(cassette_body.ROWS, cassette_body.COLUMNS)
        self.parts.add("panel", len(panel), grid, PANEL)
        self.parts.add("box", len(box), faces, SHELL)
        for name, piece in self._fitted(acting.neutral(), cassette_body.REST).items():
            count = len(piece)
            self.parts.add(name, count, _faces(name, count), _tones(name, count))

    def _fitted(self, p, body):
        """Return everything that is fitted to the chassis, name -> (N, 3) [cm]."""
        result = cassette_body.fittings(body) | self._scale(p)
        for side in ("r", "l"):
            pieces = cassette_parts.eye(p, side)
            result |= {f"{name}_{side}": piece for name, piece in pieces.items()}
        return result | cassette_parts.mouth(p)

    def _scale(self, p):
        """Return the tuning scale and its needle, which goes where it looks, name -> (4, 3)."""
        front = cassette_parts.FRONT
        x = 4.4 * p["gaze_x"]
        return {
            name: modelling.raised(np.array([[a, c], [b, c], [a, d], [b, d]]), front + z)
            for name, a, b, c, d, z in (
                ("scale", -5.6, 5.6, 5.6, 7.6, 0.3),
                ("needle", x - 0.28, x + 0.28, 5.4, 7.8, 0.55),
            )
        }

    def pose(self, p, body):
        """Return all vertices of a pose, (V, 3) [m]."""
        pieces = [self.panel, self.box, *self._fitted(p, body).values()]
        return cassette_body.warp(np.concatenate(pieces), body) / SCALE

    def masks(self):
        """Return how much upper, mouth and eyes have of each vertex, (3, V), sums of one."""
        result = np.zeros((3, self.parts.count))
        result[1, self.parts.numbers("mouth", "keys", "slab", "hub", "tape", "reel")] = 1.0
        result[2, self.parts.numbers("rim", "cone", "glint", "lid", "brow")] = 1.0
        # the panel goes with what stands on it, and what touches the panel with the panel
        result[1, self.parts.numbers("mouth")[: cassette_parts.RING]] = SEAM
        for side in ("r", "l"):
            result[2, self.parts.numbers(f"rim_{side}")[: cassette_parts.ROUND]] = SEAM
        middles = (cassette_parts.MOUTH, *cassette_parts.EYE.values())
        for row, middle in zip((1, 2, 2), middles, strict=True):
            off = np.linalg.norm(self.panel[:, :2] - middle, axis=1)
            result[row, : len(self.panel)] += SEAM * (1 - fields.smoothstep(5.5, 8.0, off))
        result = np.round(result, 2)
        result[0] = np.round(1 - result[1] - result[2], 2)
        return result


def poses(player):
    """Return every extreme's vertices, `<layer>_<name>` -> (V, 3) [m]."""
    emotions = acting.bodies(cassette_body.BODIES, cassette_body.REST)
    return {
        f"{layer}_{name}": player.pose(p, emotions.get(name, cassette_body.REST))
        for (layer, name), p in acting.faces().items()
    }


def build():
    """Return the cassette player, ready to write."""
    player = Cassette()
    neutral = player.pose(acting.neutral(), cassette_body.REST)
    faces, colours = np.array(player.parts.faces), np.concatenate(player.parts.colours)
    masks = player.masks()
    return extreme_files.Played("cassette", neutral, poses(player), faces, colours, masks, 6, ROW)
