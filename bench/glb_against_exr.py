"""Evaluate `mesh.glb` with a reader of its own and compare it with `mesh.exr`, frame by frame.

`python -m bench.glb_against_exr FOLDER...` takes folders of takes. Nothing of the package is used:
the GLB is decoded here from the specification of glTF 2.0 (sparse accessors, animation samplers,
node hierarchy), the EXR by the OpenEXR library. Exit code 1 if a take differs by more than 1e-5 of
the character's size.
"""

import json
import struct
import sys
from pathlib import Path

import numpy as np
import OpenEXR

TOLERANCE = 1e-5
CHUNK_JSON, CHUNK_BINARY = 0x4E4F534A, 0x004E4942
KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
# glTF is y up: a file with z up is turned by -90 degrees about x
UPRIGHT = {"y": np.eye(3), "z": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])}


class Glb:
    """A GLB file, decoded from its bytes."""

    def __init__(self, path: Path):
        data = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", data)
        if (magic, version, length) != (b"glTF", 2, len(data)):
            raise ValueError(f"{path}: no GLB of version 2")
        self.binary, place = b"", 12
        while place < length:
            size, kind = struct.unpack_from("<II", data, place)
            chunk = data[place + 8 : place + 8 + size]
            if kind == CHUNK_JSON:
                self.document = json.loads(chunk)
            elif kind == CHUNK_BINARY:
                self.binary = chunk
            place += 8 + size

    def _numbers(self, view: int, offset: int, kind: int, count: int, width: int) -> np.ndarray:
        """Read tightly packed numbers of a buffer view."""
        place = self.document["bufferViews"][view].get("byteOffset", 0) + offset
        numbers = np.frombuffer(self.binary, KINDS[kind], count * width, place)
        return numbers.reshape(count, width)

    def accessor(self, number: int) -> np.ndarray:
        """Return an accessor's (N, C) numbers; sparse ones are filled in."""
        entry = self.document["accessors"][number]
        count, width = entry["count"], WIDTHS[entry["type"]]
        if "bufferView" in entry:
            offset = entry.get("byteOffset", 0)
            values = self._numbers(
                entry["bufferView"], offset, entry["componentType"], count, width
            ).astype(float)
        else:
            values = np.zeros((count, width))
        if "sparse" in entry:
            sparse = entry["sparse"]
            at, filled = sparse["indices"], sparse["values"]
            rows = self._numbers(
                at["bufferView"], at.get("byteOffset", 0), at["componentType"], sparse["count"], 1
            )
            values[rows[:, 0]] = self._numbers(
                filled["bufferView"],
                filled.get("byteOffset", 0),
                entry["componentType"],
                sparse["count"],
                width,
            )
        return values

    def curves(self) -> tuple[np.ndarray, dict[tuple[int, str], np.ndarray]]:
        """Return the key times (T,) and the keys (T, C) of every animated property of a node."""
        animation = self.document["animations"][0]
        keys = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times = self.accessor(sampler["input"])[:, 0]
            values = self.accessor(sampler["output"]).reshape(len(times), -1)
            keys[channel["target"]["node"], channel["target"]["path"]] = values
        return times, keys

    def positions(self, frame: int, keys: dict[tuple[int, str], np.ndarray]) -> np.ndarray:
        """Return the (V, 3) positions of the scene's mesh at one key."""
        nodes = self.document["nodes"]
        parents = {child: n for n, node in enumerate(nodes) for child in node.get("children", [])}
        holder = next(n for n, node in enumerate(nodes) if "mesh" in node)
        primitive = self.document["meshes"][nodes[holder]["mesh"]]["primitives"][0]
        points = self.accessor(primitive["attributes"]["POSITION"])
        weights = keys.get((holder, "weights"))
        for row, target in enumerate(primitive.get("targets", [])):
            points = points + weights[frame, row] * self.accessor(target["POSITION"])
        node = holder
        while node is not None:
            move = {name: keys[node, name][frame] for name in MOVES if (node, name) in keys}
            points = _moved(points, nodes[node] | move)
            node = parents.get(node)
        return points


MOVES = ("translation", "rotation", "scale")


def _moved(points: np.ndarray, node: dict) -> np.ndarray:
    """Scale, turn and shift points by a node: q (0, p) q* with the quaternion q."""
    points = points * node.get("scale", [1, 1, 1])
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    vector = np.array([x, y, z])
    once = 2 * np.cross(vector, points)
    turned = points + w * once + np.cross(vector, once)
    return turned + node.get("translation", [0, 0, 0])


def baked(folder: Path) -> tuple[np.ndarray, dict]:
    """Return the (T, V, 3) positions of `mesh.exr` and what `mesh.json` says."""
    layout = json.loads((folder / "mesh.json").read_text())
    with OpenEXR.File(str(folder / "mesh.exr"), separate_channels=True) as file:
        planes = [file.channels()[name].pixels for name in "RGB"]
    points = np.stack(planes, axis=-1).reshape(layout["frames"], -1, 3)
    return points[:, : layout["vertices"]], layout


def greatest_difference(folder: Path) -> float:
    """Return the greatest distance between the two files over all frames and vertices.

    Returns
    -------
    share of the character's size, the diagonal of its bounds
    """
    expected, layout = baked(folder)
    glb = Glb(folder / "mesh.glb")
    times, keys = glb.curves()
    wanted = (layout["first_frame"] + np.arange(layout["frames"])) * layout["fps_den"]
    np.testing.assert_allclose(times, wanted / layout["fps_num"], rtol=1e-6, atol=1e-6)
    metres = layout["metres_per_unit"]
    turn = UPRIGHT[layout["axes"]["up"]]
    size = metres * np.linalg.norm(np.subtract(layout["bounds"]["max"], layout["bounds"]["min"]))
    worst = 0.0
    for frame, points in enumerate(expected.astype(float)):
        difference = glb.positions(frame, keys) - metres * points @ turn.T
        worst = max(worst, np.linalg.norm(difference, axis=1).max())
    return worst / size


def main() -> None:
    """Print the difference of every take named on the command line."""
    worst = 0.0
    for name in sys.argv[1:]:
        difference = greatest_difference(Path(name))
        worst = max(worst, difference)
        sys.stdout.write(
            f"{name}: mesh.glb differs from mesh.exr by {difference:.2e} of the size\n"
        )
    raise SystemExit(1 if worst > TOLERANCE else 0)


if __name__ == "__main__":
    main()
