"""Evaluate a texture as a material does: by the mesh's texture coordinates, pixel by pixel.

Only what stands in the files is used: the EXR is decoded by `exr_reader`, the mesh line by line.
"""

import json
from pathlib import Path

import numpy as np

from bench import exr_reader


def mesh(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 3) and texture coordinates (V, 2) of an OBJ."""
    rows = {"v": [], "vt": []}
    for line in path.read_text().splitlines():
        word, *cells = line.split()
        if word in rows:
            rows[word].append([float(cell) for cell in cells])
        elif any(len(set(cell.split("/"))) != 1 for cell in cells):
            raise ValueError(f"{path}: a corner has the texture coordinate of another vertex")
    return np.array(rows["v"]), np.array(rows["vt"])


def fetch(pixels: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return the pixels (V, 3) at texture coordinates, the nearest one each."""
    height, width = pixels.shape[:2]
    column = np.floor(places[:, 0] * width).astype(int)
    row = np.floor((1 - places[:, 1]) * height).astype(int)
    return pixels[row, column]


def plain(folder: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times (T,), positions and normals (T, V, 3) of the plain layout."""
    said = json.loads((folder / "texture.json").read_text())
    offset, gain = (np.array(said["scaling"][name]) for name in ("offset", "gain"))
    step = said["blocks"] / said["height"]
    return _played(folder, said, offset, gain, step)


def openvat(folder: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times (T,), positions and normals (T, V, 3) of OpenVAT's layout, y up.

    As its materials do: remap by `os-remap`, then x, z, -y.
    """
    document = json.loads((folder / "texture.json").read_text())
    low, high = (np.array(document["os-remap"][name]) for name in ("Min", "Max"))
    said = document["keyface"] | {"frames": document["os-remap"]["Frames"]}
    step = 1 / said["height"]
    turn = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    return _played(folder, said, low, high - low, step, turn)


def _played(
    folder: Path,
    said: dict,
    offset: np.ndarray,
    gain: np.ndarray,
    step: float,
    turn: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Move the mesh frame by frame, deviations and normals turned to the mesh's axes."""
    turn = np.eye(3) if turn is None else turn
    vertices, places = mesh(folder / "texture_mesh.obj")
    pixels = exr_reader.read(folder / "texture.exr")
    normals = exr_reader.read(folder / "texture_normals.exr")
    found, turned = [], []
    for frame in range(said["frames"]):
        at = places - [0, frame * step]
        found.append(vertices + (offset + gain * fetch(pixels, at)) @ turn.T)
        turned.append((2 * fetch(normals, at) - 1) @ turn.T)
    numbers = said["first_frame"] + np.arange(said["frames"])
    return numbers * said["fps_den"] / said["fps_num"], np.array(found), np.array(turned)
