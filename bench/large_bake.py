"""Time and memory of rigs of many local shapes: `python -m bench.large_bake`.

A plate of 100 x 100 vertices and shapes that each move a spot of it, 300 frames with two fifths of
the weights above zero.
"""

import resource
import sys
import tempfile
import time
from fractions import Fraction
from pathlib import Path

import numpy as np

from stages import bake_mesh
from stages.core import local_shapes
from stages.files import rig, weights

SIDE, FRAMES = 100, 300
COUNTS = (46, 250, 946)
RADIUS = 11.0


def plate() -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (V, 3) and quads (N, 4) of the plate."""
    across, up = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    vertices = np.stack([across.ravel(), up.ravel(), np.zeros(SIDE**2)], axis=1).astype(float)
    first = (SIDE * np.arange(SIDE - 1)[:, None] + np.arange(SIDE - 1)).ravel()
    return vertices, first[:, None] + [0, SIDE, SIDE + 1, 1]


def made(count: int) -> rig.Rig:
    """Return a rig with some number of shapes."""
    rng = np.random.default_rng(count)
    vertices, quads = plate()

    def spots():
        for _ in range(count):
            far = np.linalg.norm(vertices - vertices[rng.integers(len(vertices))], axis=1)
            yield np.maximum(1 - far / RADIUS, 0)[:, None] * rng.normal(size=3)

    return rig.Rig(
        names=[f"face.shape{number}" for number in range(count)],
        mask_names=["face"],
        controls=[],
        neutral=vertices,
        deltas=local_shapes.gather(spots()),
        masks=np.ones((1, len(vertices))),
        mask_index=np.zeros(count, np.int32),
        sizes=np.full(len(quads), 4, np.int32),
        corners=quads.ravel().astype(np.int32),
        colours=np.zeros((0, 3)),
        pivot=np.zeros(3),
        unit="cm",
        up_axis="y",
        face_unit=20.0,
    )


def bake(count: int, folder: Path) -> str:
    """Return the line of the table for some number of shapes."""
    rng = np.random.default_rng(1)
    played = np.clip(rng.random((FRAMES, count)) - 0.6, 0, 1)
    character = made(count)
    rig.write(folder / "rig.npz", character)
    columns = dict(zip(character.names, played.T, strict=True))
    still = np.tile([0.0, 0.0, 0.0, 1.0], (FRAMES, 1))
    columns |= weights.head_columns(still, still) | {"confidence": np.ones(FRAMES)}
    paths = folder / "weights.parquet", folder / "weights.csv"
    weights.write(*paths, np.arange(FRAMES), columns, Fraction(30))
    argv = ["--rig", str(folder / "rig.npz"), "--weights", str(paths[0])]
    for name in ("exr", "json", "pc2", "glb"):
        argv += [f"--{name}", str(folder / f"mesh.{name}")]
    start = time.process_time()
    bake_mesh.main(argv)
    seconds = time.process_time() - start
    megabytes = (folder / "rig.npz").stat().st_size / 1e6
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    return f"{count:6} {seconds:8.1f} {FRAMES / seconds:9.0f} {megabytes:9.1f} {peak:9.0f}"


if __name__ == "__main__":
    sys.stdout.write(f"{SIDE**2} vertices, {FRAMES} frames\n")
    sys.stdout.write("shapes  cpu [s]  frames/s  rig [MB] peak [MB]\n")
    for number in COUNTS:
        with tempfile.TemporaryDirectory() as scratch:
            sys.stdout.write(bake(number, Path(scratch)) + "\n")
            sys.stdout.flush()
