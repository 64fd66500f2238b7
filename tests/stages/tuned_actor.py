"""An actor whose points move with planted weights, a rig, and the pairs of animators."""

from fractions import Fraction

import numpy as np

from stages import predict_weights
from stages.core import local_shapes
from stages.files import rig, series

SHAPES = ["jawOpen", "smileLeft", "smileRight", "blink", "browUp"]
FRAMES, POINTS, RATE = 400, 14, Fraction(120)
AXES = {"markers": "xyz", "video": "xy"}


def curves(seed=0, frames=FRAMES):
    """Return smooth weights (T, K) within 0..1."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0, 1, frames)[:, None]
    speed, phase = rng.uniform(2, 9, len(SHAPES)), rng.uniform(0, 6, len(SHAPES))
    return 0.5 - 0.5 * np.cos(2 * np.pi * speed * time + phase)


class TunedActor:
    """A folder with a rig, the expressions of two shots, and pairs of one animator."""

    def __init__(self, folder, kind="markers", bend=0.0, noise=1e-4):
        self.folder, self.kind, self.bend = folder, kind, bend
        rng = np.random.default_rng(7)
        self.axes = AXES[kind]
        count = len(self.axes)
        self.neutral = rng.normal(size=(POINTS, count))
        self.shapes = 0.1 * rng.normal(size=(len(SHAPES), POINTS, count))
        self.names = [f"m{index}" for index in range(POINTS)]
        self.rng, self.noise = rng, noise
        self.write_rig()
        self.weights = {shot: curves(seed) for seed, shot in enumerate(("rom", "talk"))}
        for shot, weights in self.weights.items():
            self.write_expression(shot, self.moved(weights))
        self.tuned = np.linspace(0, FRAMES - 1, 60).astype(int)
        self.write_pairs(
            "ann", [("rom", frame, self.weights["rom"][frame]) for frame in self.tuned]
        )

    def moved(self, weights):
        """Return points (T, P, D): linear in the weights, but that one makes another yield."""
        yielding = weights.copy()
        yielding[:, 1] *= 1 - self.bend * weights[:, 0]
        offsets = np.tensordot(yielding, self.shapes, 1)
        return self.neutral + offsets + self.noise * self.rng.normal(size=offsets.shape)

    def write_rig(self, names=SHAPES):
        neutral = np.zeros((8, 3))
        deltas = local_shapes.gather(
            np.eye(8)[k % 8][:, None] * np.ones(3) for k in range(len(names))
        )
        made = rig.Rig(
            [f"face.{name}" for name in names],
            ["face"],
            [],
            neutral,
            deltas,
            np.ones((1, 8)),
            np.zeros(len(names), int),
            np.array([3]),
            np.array([0, 1, 2]),
            np.zeros((0, 3)),
            np.zeros(3),
            "cm",
            "y",
            1.0,
        )
        rig.write(self.folder / "rig.npz", made)

    def write_expression(self, shot, points, confidence=None):
        frames = np.arange(len(points))
        sure = np.ones(len(points)) if confidence is None else confidence
        columns = series.unstack(points, self.names, self.axes) | {"confidence": sure}
        columns["markers.confidence"] = sure
        meta = {"points": [], "neutral": [], "markers": [], "marker_neutral": []}
        if self.kind == "markers":
            meta |= {"markers": self.names, "marker_neutral": self.neutral.tolist()}
        else:
            meta |= {"points": self.names, "neutral": self.neutral.tolist()}
        path = self.folder / f"{shot}.parquet"
        series.write(path, "expression", frames, frames / 120, columns, RATE, meta)

    def write_pairs(self, animator, rows, shapes=SHAPES, suffix="tsv"):
        between = "\t" if suffix == "tsv" else ","
        lines = [["shot", "frame", *shapes]]
        lines += [
            [shot, str(frame), *(f"{w:.6f}" for w in weights)] for shot, frame, weights in rows
        ]
        path = self.folder / f"{animator}.{suffix}"
        path.write_text("".join(between.join(line) + "\n" for line in lines))
        return str(path)

    def train_words(self, pairs=("ann.tsv",), shots=("rom",), **options):
        """Return the command line of train_rbf, single options changed."""
        given = {
            "points": self.kind,
            "rig": str(self.folder / "rig.npz"),
            "channels": "",
            "regression": "linear",
            "dimensions": "cross_validated",
            "widths": "cross_validated",
            "min-confidence": "0.5",
            "rbf": str(self.folder / "rbf.npz"),
            "residuals": str(self.folder / "pair_residuals.parquet"),
        } | {name.replace("_", "-"): value for name, value in options.items()}
        words = [word for name, value in given.items() for word in (f"--{name}", value)]
        expressions = [str(self.folder / f"{shot}.parquet") for shot in shots]
        words += ["--expressions", *expressions, "--shots", *shots]
        return [*words, "--pairs", *(str(self.folder / pair) for pair in pairs)]

    def predict_words(self, shot="talk", **options):
        """Return the command line of predict_weights, single options changed."""
        given = {
            "rbf": str(self.folder / "rbf.npz"),
            "expression": str(self.folder / f"{shot}.parquet"),
            "points": self.kind,
            "rig": str(self.folder / "rig.npz"),
            "channels": "",
            "predicted": str(self.folder / "predicted.parquet"),
        } | {name.replace("_", "-"): value for name, value in options.items()}
        return [word for name, value in given.items() for word in (f"--{name}", value)]

    def predicted(self, **options):
        """Run predict_weights and return weights (T, K) and the series."""
        predict_weights.main(self.predict_words(**options))
        read = series.read(self.folder / "predicted.parquet", "predicted")
        return np.stack([read.columns[f"face.{name}"] for name in SHAPES], axis=1), read
