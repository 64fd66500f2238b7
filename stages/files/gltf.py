"""`mesh.glb`: the moving character as glTF 2.0 morph targets, evaluated by any viewer.

Nodes: `character` (constant: the file's axes and unit to glTF's y up and metres) > `head`
(animated: translation pivot + face_unit t, rotation, scale) > `mesh` (translation -pivot, and
animated weights). Below `character`, evaluating gives exactly the positions of `mesh.exr`.
One morph target for each shape that is not zero under its mask, and a second, `<name>.minus`, where
its weight goes below zero; scaled so that weights stay within 0 and 1, since packages clamp them
(`mesh.extras.gains` says by how much). Targets are sparse accessors, their names stand in
`mesh.extras.targetNames`, rate, first frame and its timecode in `animations[0].extras`. Vertices
are the file's, one to one; polygons are cut into fans.
"""

import dataclasses
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path

import numpy as np
import pygltflib as gltf

from stages.core import local_shapes, srgb, take_motion
from stages.files import rig

UPRIGHT = {"y": [0.0, 0.0, 0.0, 1.0], "z": [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]}
KINDS = {1: gltf.SCALAR, 3: gltf.VEC3, 4: gltf.VEC4}


@dataclasses.dataclass(frozen=True)
class Surface:
    """What a viewer draws of a character.

    Attributes
    ----------
    triangles : (N, 3) int array
    normals : (V, 3) float array, of the neutral
    names : M names of morph targets
    gains : (M,) float array, a target's differences are so many times its shape's
    targets : M shapes, differences from the neutral [unit]
    """

    triangles: np.ndarray
    normals: np.ndarray
    names: list[str]
    gains: np.ndarray
    targets: local_shapes.LocalShapes


class _Buffer:
    """The binary part of a GLB while it grows, and the views and accessors into it."""

    def __init__(self):
        self.data = bytearray()
        self.views: list[gltf.BufferView] = []
        self.accessors: list[gltf.Accessor] = []

    def view(self, array: np.ndarray, target: int | None = None) -> int:
        """Append an array, aligned to four bytes; return the number of its view."""
        self.data.extend(b"\0" * (-len(self.data) % 4))
        view = gltf.BufferView(
            buffer=0, byteOffset=len(self.data), byteLength=array.nbytes, target=target
        )
        self.data.extend(array.tobytes())
        self.views.append(view)
        return len(self.views) - 1

    def dense(self, values: np.ndarray, target: int | None = None) -> int:
        """Append (N, C) or (N,) float32 values; return the number of their accessor."""
        rows = np.ascontiguousarray(values, "<f4").reshape(len(values), -1)
        accessor = gltf.Accessor(
            bufferView=self.view(rows, target),
            componentType=gltf.FLOAT,
            count=len(rows),
            type=KINDS[rows.shape[1]],
            min=rows.min(axis=0).tolist(),
            max=rows.max(axis=0).tolist(),
        )
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def indices(self, triangles: np.ndarray) -> int:
        """Append the vertex indices of triangles; return the number of their accessor."""
        flat = np.ascontiguousarray(triangles, "<u4").ravel()
        view = self.view(flat, gltf.ELEMENT_ARRAY_BUFFER)
        self.accessors.append(
            gltf.Accessor(
                bufferView=view,
                componentType=gltf.UNSIGNED_INT,
                count=len(flat),
                type=gltf.SCALAR,
            )
        )
        return len(self.accessors) - 1

    def sparse(self, vertices: np.ndarray, rows: np.ndarray, count: int) -> int:
        """Append what moves (N, 3) of (count, 3) values; return the number of their accessor."""
        places = gltf.AccessorSparseIndices(
            bufferView=self.view(vertices.astype("<u4")), componentType=gltf.UNSIGNED_INT
        )
        stored = gltf.AccessorSparseValues(bufferView=self.view(rows))
        # the accessor holds the zeros of all other vertices too
        ends = rows if len(rows) == count else np.concatenate([rows, np.zeros((1, 3), "<f4")])
        self.accessors.append(
            gltf.Accessor(
                byteOffset=None,  # not allowed where there is no view, yet written by default
                componentType=gltf.FLOAT,
                count=count,
                type=gltf.VEC3,
                min=ends.min(axis=0).tolist(),
                max=ends.max(axis=0).tolist(),
                sparse=gltf.Sparse(count=len(vertices), indices=places, values=stored),
            )
        )
        return len(self.accessors) - 1


def write(
    path: str | Path,
    character: rig.Rig,
    surface: Surface,
    motion: take_motion.TakeMotion,
    frame: np.ndarray,
    rate: Fraction,
    start: Mapping[str, str] | None = None,
) -> None:
    """Write a moving character.

    Parameters
    ----------
    path : the GLB file
    character : the rig of a mesh
    surface : how it looks
    motion : how it moves; weights (T, M) of the morph targets
    frame : (T,) int array, numbers of the frames
    rate : frames per second
    start : what else is said of the first frame, such as its timecode
    """
    buffer = _Buffer()
    moved = _float32(surface.targets)
    used = np.flatnonzero([len(vertices) for vertices, _ in moved])
    document = gltf.GLTF2(
        scene=0,
        scenes=[gltf.Scene(nodes=[0])],
        nodes=_nodes(character, motion),
        meshes=[_mesh(buffer, character, surface, [moved[row] for row in used], used)],
        materials=[_material()],
        animations=[_animation(buffer, character, motion, used, frame, rate, start or {})],
    )
    document.accessors, document.bufferViews = buffer.accessors, buffer.views
    document.buffers = [gltf.Buffer(byteLength=len(buffer.data))]
    document.set_binary_blob(bytes(buffer.data))
    document.save_binary(str(path))


def _nodes(character: rig.Rig, motion: take_motion.TakeMotion) -> list[gltf.Node]:
    """Return the three nodes, at rest in the first frame's pose."""
    upright = gltf.Node(
        name="character",
        children=[1],
        rotation=UPRIGHT[character.up_axis],
        scale=[rig.METRES[character.unit]] * 3,
    )
    head = gltf.Node(
        name="head",
        children=[2],
        translation=_places(character, motion)[0].tolist(),
        rotation=motion.rotation[0].tolist(),
        scale=[float(motion.scale[0])] * 3,
    )
    return [upright, head, gltf.Node(name="mesh", mesh=0, translation=(-character.pivot).tolist())]


def _places(character: rig.Rig, motion: take_motion.TakeMotion) -> np.ndarray:
    """Return the (T, 3) translations of the head's node."""
    return character.pivot + motion.translation


def _material() -> gltf.Material:
    """Return a matt material, seen from both sides so that a flat drawing shows."""
    matt = gltf.PbrMetallicRoughness(metallicFactor=0.0, roughnessFactor=0.8)
    return gltf.Material(name="skin", pbrMetallicRoughness=matt, doubleSided=True)


def _float32(shapes: local_shapes.LocalShapes) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the vertices (N,) and float32 differences (N, 3) of each shape that are not zero."""
    made = []
    for start, stop in zip(shapes.first[:-1], shapes.first[1:], strict=True):
        rows = np.ascontiguousarray(shapes.values[start:stop], "<f4")
        filled = rows.any(axis=1)
        made.append((shapes.vertices[start:stop][filled], rows[filled]))
    return made


def _mesh(
    buffer: _Buffer,
    character: rig.Rig,
    surface: Surface,
    moved: list[tuple[np.ndarray, np.ndarray]],
    used: np.ndarray,
) -> gltf.Mesh:
    """Return the mesh with its morph targets."""
    attributes = gltf.Attributes(
        POSITION=buffer.dense(character.neutral, gltf.ARRAY_BUFFER),
        NORMAL=buffer.dense(surface.normals, gltf.ARRAY_BUFFER),
    )
    if len(character.colours):
        attributes.COLOR_0 = buffer.dense(srgb.linear(character.colours), gltf.ARRAY_BUFFER)
    primitive = gltf.Primitive(
        attributes=attributes,
        indices=buffer.indices(surface.triangles),
        material=0,
        targets=[{"POSITION": buffer.sparse(*shape, len(character.neutral))} for shape in moved],
    )
    extras = {
        "targetNames": [surface.names[row] for row in used],
        "gains": surface.gains[used].tolist(),
    }
    return gltf.Mesh(
        name="face",
        primitives=[primitive],
        weights=[0.0] * len(used),
        extras=extras,
    )


def _animation(
    buffer: _Buffer,
    character: rig.Rig,
    motion: take_motion.TakeMotion,
    used: np.ndarray,
    frame: np.ndarray,
    rate: Fraction,
    start: Mapping[str, str],
) -> gltf.Animation:
    """Return the animation: three channels of the head, one of weights."""
    times = buffer.dense(frame * rate.denominator / rate.numerator)
    curves = [
        (1, "translation", _places(character, motion)),
        (1, "rotation", motion.rotation),
        (1, "scale", np.repeat(motion.scale[:, None], 3, axis=1)),
    ]
    if len(used):
        curves.append((2, "weights", motion.weights[:, used].ravel()))
    samplers = [
        gltf.AnimationSampler(input=times, output=buffer.dense(values)) for *_, values in curves
    ]
    channels = [
        gltf.AnimationChannel(
            sampler=number, target=gltf.AnimationChannelTarget(node=node, path=path)
        )
        for number, (node, path, _) in enumerate(curves)
    ]
    clock = {
        "fps_num": rate.numerator,
        "fps_den": rate.denominator,
        "first_frame": int(frame[0]),
        "frames": len(frame),
    }
    return gltf.Animation(name="take", samplers=samplers, channels=channels, extras=clock | start)
