"""An actor with planted layers, in space and in the picture, and a character with the same ones."""

from fractions import Fraction
from pathlib import Path

import numpy as np

from stages import assemble_simplices, transfer_layers
from stages.core import local_shapes
from stages.files import delimited, expressions, poses, rig, series

EXTREMES_TABLE = Path(__file__).parents[2] / "stages" / "tables" / "extremes.tsv"
EXTREMES = [
    *(("emotion", name) for name in ("neutral", "joy", "grief", "rage", "contempt")),
    *(("speech", name) for name in ("rest", "m", "oo", "aa")),
    *(("blink", name) for name in ("open", "half", "closed")),
]
LAYERS = ["emotion", "speech", "blink"]
LAYER = np.array([LAYERS.index(layer) for layer, _ in EXTREMES])
MASKS = ["upper", "mouth", "eyes"]
MARKERS = [f"{mask[0].upper()}{i}" for mask in MASKS for i in range(8)]
POINTS = [f"{contour}_{i:02d}" for contour in ("brow", "lips", "eye") for i in range(6)]
MASK_ROWS = [
    *(("upper", "*"), ("mouth", "lips"), ("eyes", "eye")),
    *(("mouth", name) for name in MARKERS[8:16]),
    *(("eyes", name) for name in MARKERS[16:]),
]
LIPS = "lips_00,lips_01"
FIRST = 10  # frame of the first extreme in the shot `faces`
RATE = Fraction(60)
VERTICES = 30


def smooth_simplex(rng, frames, count):
    """Return (T, N) points that wander over a simplex, one in sum."""
    time = np.linspace(0, 1, frames)[:, None]
    waves = np.sin(2 * np.pi * rng.uniform(1, 3, count) * time + rng.uniform(0, 6, count))
    shares = np.exp(1.5 * waves)
    return shares / shares.sum(axis=1, keepdims=True)


class LayeredActor:
    """A folder with two shots, tables, and a character's rig and poses.

    Attributes
    ----------
    basis : (D, K) float array, the actor's extremes, markers first
    weights, coefficients : (T, R, J) and (T, K) float arrays, planted in the shot `play`
    """

    def __init__(self, folder, frames=40, seed=0):
        self.folder = folder
        rng = self.rng = np.random.default_rng(seed)
        self.neutrals = rng.normal(size=(len(MARKERS), 3)), rng.normal(size=(len(POINTS), 2))
        self.sizes = 3 * len(MARKERS), 2 * len(POINTS)
        self.basis = 0.1 * rng.normal(size=(sum(self.sizes), len(EXTREMES)))
        self.mask = np.concatenate(
            [np.repeat([0, 1, 2], 8).repeat(3), np.repeat([0, 1, 2], 6).repeat(2)]
        )
        self.weights = np.stack([smooth_simplex(rng, frames, 3) for _ in MASKS], axis=1)
        self.coefficients = np.concatenate(
            [smooth_simplex(rng, frames, np.sum(j == LAYER)) for j in range(3)], axis=1
        )
        self.picked = [
            ["mia", layer, name, "faces", str(FIRST + place)]
            for place, (layer, name) in enumerate(EXTREMES)
        ]
        self.masks = [["mia", mask, point, ""] for mask, point in MASK_ROWS]
        self.offsets = {
            "faces": np.concatenate([np.zeros((FIRST, len(self.basis))), self.basis.T]),
            "play": self.composed(self.weights, self.coefficients),
        }
        self.write()
        self.write_character(EXTREMES)

    def composed(self, weights, coefficients):
        """Return the offsets (T, D) of the paper's equation 4."""
        gains = weights[:, :, LAYER] * coefficients[:, None]
        moved = np.einsum("dk,trk->trd", self.basis, gains)
        return np.take_along_axis(moved, self.mask[None, None], axis=1)[:, 0]

    def write(self):
        """Write tables and expressions as they now are."""
        delimited.write(self.folder / "expressions.tsv", expressions.COLUMNS, self.picked)
        columns = ("actor", "mask", "point", "weight")
        delimited.write(self.folder / "actor_masks.tsv", columns, self.masks)
        for shot, offsets in self.offsets.items():
            self.write_expression(self.folder / f"{shot}.parquet", offsets)

    def write_expression(self, path, offsets, rate=RATE, kinds=("markers", "points")):
        """Write offsets (T, D) as the expression of a shot."""
        frame = np.arange(len(offsets))
        space, picture = np.split(offsets, [self.sizes[0]], axis=1)
        space = self.neutrals[0] + space.reshape(len(frame), -1, 3)
        picture = self.neutrals[1] + picture.reshape(len(frame), -1, 2)
        columns, meta = {}, {}
        if "markers" in kinds:
            columns |= series.unstack(space, MARKERS, "xyz")
            columns["markers.confidence"] = np.full(len(frame), 0.8)
            meta |= {"markers": MARKERS, "marker_neutral": self.neutrals[0].tolist()}
        if "points" in kinds:
            columns |= series.unstack(picture, POINTS) | {"confidence": np.full(len(frame), 0.9)}
            meta |= {"points": POINTS, "neutral": self.neutrals[1].tolist()}
        series.write(path, "expression", frame, frame / float(rate), columns, rate, meta)

    def write_mouth(self, open_poses):
        """Write a rig of two lips of ten vertices, half a face unit apart in some poses."""
        neutral = np.column_stack([np.tile(np.linspace(-1, 1, 10), 2), np.zeros((20, 2))])
        moved = np.repeat([[0, -0.25, 0], [0, 0.25, 0]], 10, axis=0)
        self._write_rig(
            EXTREMES, MASKS, neutral, {e: moved * (e in open_poses) for e in EXTREMES}, np.eye(3)[1]
        )

    def write_character(self, extremes, masks=MASKS):
        """Write a rig and its poses, all of random differences from the neutral."""
        rng = np.random.default_rng(5)
        deltas = {extreme: rng.normal(size=(VERTICES, 3)) for extreme in EXTREMES}
        shares = rng.random((len(masks), VERTICES))
        self._write_rig(extremes, masks, rng.normal(size=(VERTICES, 3)), deltas, shares)

    def _write_rig(self, extremes, masks, neutral, deltas, shares):
        """Write a rig and its poses, in face units of 6.5 cm."""
        shares = np.broadcast_to(shares.reshape(len(masks), -1), (len(masks), len(neutral)))
        names = [f"{mask}.{'_'.join(extreme)}" for mask in masks for extreme in extremes]
        made = rig.Rig(
            names=names,
            mask_names=list(masks),
            controls=[],
            neutral=6.5 * neutral,
            deltas=local_shapes.gather([6.5 * deltas[e] for _ in masks for e in extremes]),
            masks=shares / shares.sum(axis=0),
            mask_index=np.repeat(np.arange(len(masks)), len(extremes)),
            sizes=np.array([3]),
            corners=np.array([0, 1, 2]),
            colours=np.zeros((0, 3)),
            pivot=np.zeros(3),
            unit="cm",
            up_axis="y",
            face_unit=6.5,
        )
        rig.write(self.folder / "rig.npz", made)
        rows = [poses.Pose(*e, f"{'_'.join(e)}.ply", len(neutral)) for e in extremes]
        poses.write(self.folder / "poses.parquet", rows)

    def assemble(self, **changed):
        """Run the stage and return the path of the simplices."""
        options = {
            "actor": "mia",
            "expression-table": self.folder / "expressions.tsv",
            "mask-table": self.folder / "actor_masks.tsv",
            "shots": ["faces", "play"],
            "expressions": [self.folder / "faces.parquet", self.folder / "play.parquet"],
            "points": "both",
            "poses": self.folder / "poses.parquet",
            "rig": self.folder / "rig.npz",
            "extremes": EXTREMES_TABLE,
            "balance": "mask_variance",
            "lip-points": LIPS,
            "lip-mask": "mouth",
            "lip-sigma": 0.02,
            "simplices": self.folder / "simplices.npz",
            "report": self.folder / "simplices.tsv",
        }
        assemble_simplices.main(arguments(options, changed))
        return self.folder / "simplices.npz"

    def report(self):
        """Return what became of each extreme and point."""
        rows = delimited.read(self.folder / "simplices.tsv", ("layer", "name", "state", "detail"))
        return {(row.cells["layer"], row.cells["name"]): row.cells["state"] for row in rows}

    def transfer(self, stage=transfer_layers, **changed):
        """Run the stage and return the path of the layers."""
        options = {
            "simplices": self.folder / "simplices.npz",
            "expression": self.folder / "play.parquet",
            "lip-points": LIPS,
            "lip-mask": "mouth",
            "lip-sigma": 0,
            "temporal": 0,
            "beyond": 0,
            "lean": 0,
            "lip-bias": "published",
            "layers": self.folder / "layers.parquet",
        }
        stage.main(arguments(options, changed))
        return self.folder / "layers.parquet"


def arguments(options, changed):
    """Return a command line of options, some of them changed."""
    options = options | {name.replace("_", "-"): value for name, value in changed.items()}
    line = []
    for name, value in options.items():
        several = isinstance(value, list)
        line += [f"--{name}", *map(str, value)] if several else [f"--{name}={value}"]
    return line
