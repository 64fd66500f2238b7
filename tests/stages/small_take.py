"""A small character, its sculpts, and a take of weights and head motion, made in code."""

from fractions import Fraction

import numpy as np

from stages.files import key_shapes, series

RATE = Fraction(30)
FRAMES = 24
REGIONS = {"mouth": ["rom_f0003", "rom_f0040", "rom_f0041"], "eyes": ["rom_f0011", "rom_f0012"]}
PARAMETERS = 6


def write_obj(path, vertices, faces, colours=None):
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as stream:
        for row, vertex in enumerate(vertices):
            cells = [*vertex, *(colours[row] if colours is not None else [])]
            stream.write("v " + " ".join(f"{value:.9f}" for value in cells) + "\n")
        for face in faces:
            stream.write("f " + " ".join(str(index + 1) for index in face) + "\n")


def words(options):
    """Return the words of a command line: a flag and a value for each option."""
    return [word for name, value in options.items() for word in (f"--{name}", value)]


def changed_by(changes):
    """Return options by keyword arguments: `sculpt_folder` is the flag `--sculpt-folder`."""
    return {name.replace("_", "-"): value for name, value in changes.items()}


class SmallTake:
    """A folder with everything that the stages from the rig on need."""

    def __init__(self, folder, seed=0, size=10.0, up="y", coloured=True, sculpt_error=0.0):
        self.folder, self.up = folder, up
        rng = np.random.default_rng(seed)
        columns, rows = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1.2, 1.2, 11))
        depth = 1.5 - columns**2 - 0.4 * rows**2
        face = np.stack([columns, rows, depth], axis=-1).reshape(-1, 3)
        # the file's axes: with z up the face looks along -y
        self.axes = np.eye(3) if up == "y" else np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        self.neutral = size * face @ self.axes.T
        corners = np.arange(11 * 9).reshape(11, 9)
        self.faces = [
            (corners[r, c], corners[r, c + 1], corners[r + 1, c + 1], corners[r + 1, c])
            for r in range(10)
            for c in range(8)
        ]
        self.heights = face[:, 1]
        colours = rng.uniform(0.2, 0.9, face.shape) if coloured else None
        write_obj(folder / "char" / "neutral.obj", self.neutral, self.faces, colours)
        self._sculpt(rng, size, sculpt_error)
        self._mask()
        self._perform(rng)

    def _sculpt(self, rng, size, error):
        """Draw an actor and a character that are moved by the same parameters."""
        rows, self.deltas = [], {}
        for region, names in REGIONS.items():
            weights = rng.uniform(0, 0.5, (len(names), PARAMETERS))
            weights[np.arange(len(names)), np.arange(len(names))] = 1.0
            actor = rng.normal(scale=0.1, size=(PARAMETERS, 16))
            where = np.exp(-((self.heights - (-0.6 if region == "mouth" else 0.6)) ** 2) / 0.1)
            moved = rng.normal(scale=0.05 * size, size=(PARAMETERS, len(self.neutral), 3))
            sculpted = weights * (1 + error * rng.normal(size=weights.shape))
            for order, name in enumerate(names):
                delta = np.tensordot(sculpted[order], moved * where[:, None], axes=1)
                self.deltas[region, name] = delta
                path = self.folder / "char" / "sculpts" / region / f"{name}.obj"
                write_obj(path, self.neutral + delta, self.faces)
                row = {"region": region, "key_shape": name, "shot": "rom", "frame": int(name[-4:])}
                row |= {"order": order, "method": "given", "locked": True, "confidence": 1.0}
                row |= {"reason": "", "count_reason": "", "shape": list(weights[order] @ actor)}
                rows.append(row)
        points = {region: [f"p{i}" for i in range(8)] for region in REGIONS}
        neutral = {region: [0.0] * 16 for region in REGIONS}
        key_shapes.write(self.folder / "key_shapes.parquet", rows, points, neutral)

    def _mask(self):
        """Split eyes from mouth by a ramp between two heights."""
        axis = "y" if self.up == "y" else "z"
        low, high = (10.0 * height for height in (-0.2, 0.3))
        text = f"region\taxis\tfrom\tto\nmouth\t\t\t\neyes\t{axis}\t{low}\t{high}\n"
        (self.folder / "char" / "masks.tsv").write_text(text)

    def _perform(self, rng):
        """Draw smooth weights and head motion."""
        time = np.arange(FRAMES) / float(RATE)
        self.weights = {
            f"{region}.{name}": 0.4 + 0.4 * np.sin(rng.uniform(3, 9) * time + rng.uniform(0, 6))
            for region, names in REGIONS.items()
            for name in names
        }
        angles = 0.2 * np.sin(np.outer(time, [3, 4, 5]) + 1)
        turns = np.concatenate([angles / 2, np.ones((FRAMES, 1))], axis=1)
        self.turns = turns / np.linalg.norm(turns, axis=1, keepdims=True)
        self.shift = 0.1 * np.cos(np.outer(time, [2, 3, 1]))
        self.scale = 1 + 0.05 * np.sin(time)
        self.write_weights()
        self.write_head()

    def write_weights(self, rate=RATE, **changed):
        columns = self.weights | {"confidence": np.full(FRAMES, 0.9)} | changed
        columns |= {"mouth.residual": np.zeros(FRAMES)}
        frames = np.arange(FRAMES)
        path = self.folder / "key_weights.parquet"
        series.write(path, "key_weights", frames, frames / float(rate), columns, rate)

    def write_head(self):
        columns = {f"rotation.{a}": self.turns[:, i] for i, a in enumerate("xyzw")}
        columns |= {f"translation.{a}": self.shift[:, i] for i, a in enumerate("xyz")}
        columns |= {"scale": self.scale, "confidence": np.ones(FRAMES)}
        frames = np.arange(FRAMES)
        path = self.folder / "head_motion.parquet"
        series.write(path, "head_motion", frames, frames / float(RATE), columns, RATE)

    @property
    def sculpts(self):
        return sorted(str(path) for path in (self.folder / "char" / "sculpts").rglob("*.*"))

    def check_options(self, out, **changed):
        """Return the command line of check_sculpts."""
        options = {
            "key-shapes": f"{self.folder}/key_shapes.parquet",
            "neutral": f"{self.folder}/char/neutral.obj",
            "sculpt-folder": f"{self.folder}/char/sculpts",
            "character": "face",
            "states": str(out),
        } | changed_by(changed)
        return [*words(options), "--sculpts", *self.sculpts]

    def rig_options(self, **changed):
        """Return the command line of assemble_rig."""
        options = {
            "key-shapes": f"{self.folder}/key_shapes.parquet",
            "neutral": f"{self.folder}/char/neutral.obj",
            "sculpt-folder": f"{self.folder}/char/sculpts",
            "masks": f"{self.folder}/char/masks.tsv",
            "unit": "cm",
            "up-axis": self.up,
            "pivot": "1 -8 0.5",
            "face-unit": "6.5",
            "rig": f"{self.folder}/rig.npz",
        } | changed_by(changed)
        return [*words(options), "--sculpts", *self.sculpts]

    def weights_options(
        self,
        rate="film",
        head="apply",
        rig="rig.npz",
        solution="key_weights.parquet",
        channels="",
        smoothing="none",
        lip_points="",
        edits=(),
        first="",
        last="",
        handles="",
        start="",
    ):
        """Return the command line of smooth_weights."""
        options = {
            "solution": f"{self.folder}/{solution}",
            "expression": f"{self.folder}/expression.parquet",
            "channels": channels,
            "smoothing": smoothing,
            "lip-points": lip_points,
            "head-motion": f"{self.folder}/head_motion.parquet",
            "rig": f"{self.folder}/{rig}",
            "rate": rate,
            "head": head,
            "weights": f"{self.folder}/weights.parquet",
            "first-frame": first,
            "last-frame": last,
            "handles": handles,
            "start-timecode": start,
            "csv": f"{self.folder}/weights.csv",
        }
        return [*words(options), "--edits", *edits]

    def bake_options(self):
        """Return the command line of bake_mesh."""
        options = {"rig": f"{self.folder}/rig.npz", "weights": f"{self.folder}/weights.parquet"}
        options |= {kind: f"{self.folder}/mesh.{kind}" for kind in ("exr", "json", "pc2", "glb")}
        return words(options)
