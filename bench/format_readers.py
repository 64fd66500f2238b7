"""Read what the exports write without the package: times [s] and positions in the character's axes.

Each function takes the folder of a take's files and returns times (T,) and positions (T, V, 3).
"""

import json
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np

from bench import exr_reader, glb_against_exr, texture_reader, usd_reader

Found = tuple[np.ndarray, np.ndarray]


def _layout(folder: Path) -> dict:
    """Return what `mesh.json` says."""
    return json.loads((folder / "mesh.json").read_text())


def _times(said: dict) -> np.ndarray:
    """Return the times of a description with a clock."""
    numbers = said["first_frame"] + np.arange(said["frames"])
    return numbers * said["fps_den"] / said["fps_num"]


def exr(folder: Path) -> Found:
    """Decode `mesh.exr` from its bytes."""
    said = _layout(folder)
    points = exr_reader.read(folder / "mesh.exr").reshape(said["frames"], -1, 3)
    return _times(said), points[:, : said["vertices"]]


def pc2(folder: Path) -> Found:
    """Decode `mesh.pc2` by its specification; the rate is in `mesh.json`."""
    data = (folder / "mesh.pc2").read_bytes()
    magic, version, points, start, sampling, frames = struct.unpack_from("<12siiffi", data)
    if (magic, version, len(data)) != (b"POINTCACHE2\0", 1, 32 + 12 * frames * points):
        raise ValueError(f"{folder}/mesh.pc2: no point cache")
    said = _layout(folder)
    times = (start + sampling * np.arange(frames)) * said["fps_den"] / said["fps_num"]
    return times, np.frombuffer(data, "<f4", offset=32).reshape(frames, points, 3).astype(float)


def mdd(folder: Path) -> Found:
    """Decode `mesh.mdd` by its specification."""
    data = (folder / "mesh.mdd").read_bytes()
    frames, points = struct.unpack_from(">ii", data)
    if len(data) != 8 + 4 * frames + 12 * frames * points:
        raise ValueError(f"{folder}/mesh.mdd: no point cache")
    times = np.frombuffer(data, ">f4", frames, 8).astype(float)
    places = np.frombuffer(data, ">f4", offset=8 + 4 * frames)
    return times, places.reshape(frames, points, 3).astype(float)


def out_of_gltf(folder: Path) -> np.ndarray:
    """Return what undoes the turn to y up and to metres (3, 3) of `mesh.glb`."""
    said = _layout(folder)
    turn = glb_against_exr.UPRIGHT[said["axes"]["up"]] * said["metres_per_unit"]
    return np.linalg.inv(turn)


def glb(folder: Path) -> Found:
    """Evaluate `mesh.glb` from its bytes; undo its turn to y up and its metres."""
    file = glb_against_exr.Glb(folder / "mesh.glb")
    times, keys = file.curves()
    back = out_of_gltf(folder)
    found = [file.positions(frame, keys) @ back.T for frame in range(len(times))]
    return times, np.array(found)


def obj(folder: Path) -> Found:
    """Read the vertices of every OBJ file, line by line."""
    said = json.loads((folder / "obj" / "take.json").read_text())
    found = []
    for path in sorted((folder / "obj").glob("frame_*.obj")):
        lines = [line.split()[1:] for line in path.read_text().splitlines() if line[:2] == "v "]
        found.append(np.array(lines, float))
    numbers = [int(path.stem.split("_")[1]) for path in sorted((folder / "obj").glob("*.obj"))]
    return np.array(numbers) * said["fps_den"] / said["fps_num"], np.array(found)


def usd(folder: Path) -> Found:
    """Evaluate `mesh.usdc` by UsdSkel."""
    return usd_reader.skinned(folder / "mesh.usdc")


def points(folder: Path) -> Found:
    """Read `points.usdc`."""
    return usd_reader.sampled(folder / "points.usdc")


def texture(folder: Path) -> Found:
    """Look the plain texture up."""
    return texture_reader.plain(folder)[:2]


def openvat(folder: Path) -> Found:
    """Look OpenVAT's texture up; its mesh is y up."""
    times, found, _ = texture_reader.openvat(folder)
    return times, found @ glb_against_exr.UPRIGHT[_layout(folder.parent)["axes"]["up"]]


READERS: list[tuple[str, str, Callable[[Path], Found]]] = [
    ("mesh.exr", "own decoder", exr),
    ("mesh.pc2", "struct", pc2),
    ("mesh.mdd", "struct", mdd),
    ("mesh.glb", "own evaluator", glb),
    ("mesh.usdc", "pxr UsdSkel", usd),
    ("points.usdc", "pxr", points),
    ("obj/", "lines", obj),
    ("texture.exr float", "own decoder", lambda folder: texture(folder / "float")),
    ("texture.exr half", "own decoder", lambda folder: texture(folder / "half")),
    ("texture.exr openvat", "own decoder", lambda folder: openvat(folder / "openvat")),
]
