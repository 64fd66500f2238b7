"""A small rig, and a second writer of GLB files for tests of the reader."""

import json
import struct

import numpy as np

NEUTRAL = np.random.default_rng(3).normal(size=(6, 3)).astype("<f4")
DELTAS = np.random.default_rng(4).normal(size=(2, 6, 3)).astype("<f4")
DELTAS[1, [0, 2, 3, 5]] = 0
FACES = np.array([[0, 1, 2], [2, 3, 4], [3, 4, 5]])


class Maker:
    """A second writer: arrays become views and accessors one by one."""

    def __init__(self):
        self.blob = b""
        self.views, self.accessors = [], []

    def view(self, array, **more):
        self.blob += b"\0" * (-len(self.blob) % 4)
        place = len(self.blob)
        self.blob += array.tobytes()
        size = array.nbytes
        self.views.append({"buffer": 0, "byteOffset": place, "byteLength": size} | more)
        return len(self.views) - 1

    def add(self, array, component=5126, **more):
        rows = array.reshape(len(array), -1)
        kind = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}[rows.shape[1]]
        entry = {"componentType": component, "count": len(rows), "type": kind}
        if "sparse" not in more:
            stride = more.pop("stride", {})
            entry["bufferView"] = self.view(rows, **stride)
        self.accessors.append(entry | more)
        return len(self.accessors) - 1

    def sparse(self, rows):
        moved = np.flatnonzero(rows.any(axis=1))
        places = {"bufferView": self.view(moved.astype("<u1")), "componentType": 5121}
        held = {"bufferView": self.view(rows[moved])}
        return self.add(rows, sparse={"count": len(moved), "indices": places, "values": held})

    def document(self, parts, names=("jawOpen", "eyeBlink_L"), **more):
        mesh = {"primitives": parts}
        if names:
            mesh["extras"] = {"targetNames": list(names)}
        return {
            "asset": {"version": "2.0"},
            "meshes": [mesh],
            "nodes": [{"mesh": 0}],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.blob)}],
        } | more

    def part(self, rows=slice(None), faces=None, sparse=False):
        targets = [
            {"POSITION": (self.sparse if sparse else self.add)(delta[rows])} for delta in DELTAS
        ]
        part = {"attributes": {"POSITION": self.add(NEUTRAL[rows])}, "targets": targets}
        if faces is not None:
            part["indices"] = self.add(faces.ravel().astype("<u2"), 5123)
        return part


def save(path, document, blob):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    blob += b"\0" * (-len(blob) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(blob), 0x004E4942) + blob
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
    return path
