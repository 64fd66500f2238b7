"""A small character that plays a take of any rate and first frame, and where its vertices are."""

from fractions import Fraction

import numpy as np
import scipy.spatial.transform
from small_take import FRAMES, REGIONS, SmallTake, words

from stages import assemble_rig, bake_mesh
from stages.files import weights

RATES = [
    Fraction(rate)
    for rate in (
        "24000/1001",
        "24",
        "25",
        "30000/1001",
        "30",
        "50",
        "60000/1001",
        "60",
        "120",
    )
]
PIVOT = np.array([1.0, -8.0, 0.5])
FACE_UNIT = 6.5


class PlayedTake(SmallTake):
    """A folder with rig.npz, weights.parquet and the baked mesh."""

    def __init__(
        self,
        folder,
        up="y",
        rate=Fraction(30),
        first=0,
        count=FRAMES,
        spread=1.0,
        scaled=True,
    ):
        super().__init__(folder, up=up)
        self.rate, self.first, self.count = rate, first, count
        # beyond 0 to 1 where the spread is wide: shapes may do that
        columns = {
            name: 0.4 + spread * (np.resize(values, count) - 0.4)
            for name, values in self.weights.items()
        }
        self.played = {name: values.astype(np.float32) for name, values in columns.items()}
        turns, shift = np.resize(self.turns, (count, 4)), np.resize(self.shift, (count, 3))
        scale = np.resize(self.scale, count) if scaled else np.ones(count)
        self.moves = [values.astype(np.float32).astype(float) for values in (turns, shift, scale)]
        assemble_rig.main(self.rig_options())
        head = weights.head_columns(turns, np.c_[shift, scale])
        columns |= head | {"confidence": np.ones(count)}
        paths = self.folder / "weights.parquet", self.folder / "weights.csv"
        weights.write(*paths, np.arange(first, first + count), columns, rate)

    def bake(self, *extra):
        bake_mesh.main([*self.bake_options(), *extra])
        return self

    def positions_without_head(self):
        """Move the vertices by the written formula, in float64 loops over what was put in."""
        ramp = np.clip((self.heights + 0.2) / 0.5, 0, 1)
        masks = {"mouth": 1 - ramp, "eyes": ramp}
        frames = []
        for frame in range(self.count):
            points = self.neutral.copy()
            for region, names in REGIONS.items():
                for name in names:
                    weight = float(self.played[f"{region}.{name}"][frame])
                    points += masks[region][:, None] * weight * self.deltas[region, name]
            frames.append(points)
        return np.array(frames)

    def positions(self):
        """Move them with the head, too."""
        frames = []
        for points, *move in zip(self.positions_without_head(), *self.moves, strict=True):
            turn = scipy.spatial.transform.Rotation.from_quat(move[0]).as_matrix()
            turn = self.axes @ turn @ self.axes.T
            shift = FACE_UNIT * self.axes @ move[1]
            frames.append(PIVOT + move[2] * (points - PIVOT) @ turn.T + shift)
        return np.array(frames)

    def worst(self, found):
        """Return how far (T, V, 3) positions are from the truth, in shares of the size."""
        wanted = self.positions()
        size = np.linalg.norm(wanted.max(axis=(0, 1)) - wanted.min(axis=(0, 1)))
        assert np.shape(found) == wanted.shape
        return np.linalg.norm(found - wanted, axis=2).max() / size

    @property
    def last_time(self):
        return float((self.first + self.count - 1) / self.rate)

    def options(self, *inputs, **outputs):
        """Return a command line: inputs by their usual names, outputs by flag and file name."""
        known = {"rig": "rig.npz", "weights": "weights.parquet"}
        known |= {"exr": "mesh.exr", "json": "mesh.json"}
        given = {name: known[name] for name in inputs}
        given |= {name.replace("_", "-"): value for name, value in outputs.items()}
        return words({name: f"{self.folder}/{value}" for name, value in given.items()})
