"""Rigs of one GLB file: a mesh and its morph targets.

The space of a mesh that has morph targets alone is kept: transforms of nodes (where a scene puts
the mesh, or what undoes a quantisation) are not applied, only said. Its primitives are joined in
their order; those that share their vertices, as materials on one surface do, have them once.
Several meshes with morph targets, such as a head with teeth and eyes of their own, become one in
the space of the scene, and targets of one name become one shape.
"""

import dataclasses
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pygltflib as gltf

from stages.core import local_shapes, srgb
from stages.files import errors, glb, glb_nodes, sculpts

MOST_TARGETS = 4096
POINT, COLOUR = [gltf.VEC3], [gltf.VEC3, gltf.VEC4]
REST = {
    "translation": [0, 0, 0],
    "rotation": [0, 0, 0, 1],
    "scale": [1, 1, 1],
    "matrix": np.eye(4).ravel().tolist(),
}


@dataclasses.dataclass(frozen=True)
class GlbRig:
    """What a file holds of a rig.

    Attributes
    ----------
    neutral : the mesh with all weights at zero
    names : K names of shapes, such as rigs allow
    deltas : K shapes, differences from the neutral
    notes : what a person should know of the file, a line each
    """

    neutral: sculpts.Pose
    names: list[str]
    deltas: local_shapes.LocalShapes
    notes: list[str]


def read(path: str | Path) -> GlbRig:
    """Read a mesh with morph targets, or join several.

    Raises
    ------
    errors.InputError
        if the file is damaged, compressed, holds no mesh with morph targets, or several that cannot
        be joined without a guess
    """
    file = glb.read(path)
    meshes = _morphed(file)
    if len(meshes) == 1:
        ((number, mesh),) = meshes.items()
        made = _one(file, mesh)
        return dataclasses.replace(made, notes=made.notes + _moved(file, number) + _resting(mesh))
    places = glb_nodes.placed(file, list(meshes))
    for number, mesh in meshes.items():
        if "targetNames" not in (mesh.extras if isinstance(mesh.extras, dict) else {}):
            message = f"has {len(meshes)} meshes with morph targets, mesh {number} without names"
            cure = "name its shapes (targetNames), or join the meshes into one"
            raise errors.InputError(path, f"{message} of them: {cure}")
    return _joined(file, [(meshes[number], matrix) for number, matrix in places])


def _one(file: glb.Glb, mesh: gltf.Mesh) -> GlbRig:
    """Read one mesh in its own space."""
    parts = mesh.primitives
    counts = {len(part.targets or []) for part in parts}
    if len(counts) > 1:
        message = f"its primitives have {sorted(counts)} morph targets, expected as many each"
        raise errors.InputError(file.path, f"{message}: {glb.AGAIN}")
    (count,) = counts
    if count > MOST_TARGETS:
        message = f"has {count} morph targets, at most {MOST_TARGETS} are read: leave some out"
        raise errors.InputError(file.path, message)
    names, notes = _names(file, mesh, count)
    bases, vertices, triangles, colours = _surfaces(file, parts)
    deltas = local_shapes.gather(_deltas(file, list(bases.values()), count))
    return GlbRig(_pose(vertices, triangles, colours), names, deltas, notes)


def _pose(vertices: np.ndarray, triangles: np.ndarray, colours: np.ndarray) -> sculpts.Pose:
    """Return a mesh of triangles as a pose."""
    return sculpts.Pose(
        names=[str(vertex) for vertex in range(len(vertices))],
        coordinates=vertices,
        sizes=np.full(len(triangles), 3, np.int32),
        corners=triangles.ravel().astype(np.int32),
        colours=colours,
        is_controls=False,
    )


def _joined(file: glb.Glb, placed: list[tuple[gltf.Mesh, np.ndarray]]) -> GlbRig:
    """Read meshes and join them in the scene's space, where matrices (4, 4) put them."""
    made, vertices, triangles, colours = [], [], [], []
    for mesh, matrix in placed:
        one = _one(file, mesh)
        made.append((one, sum(map(len, vertices)), matrix[:3, :3]))
        vertices.append(one.neutral.coordinates @ matrix[:3, :3].T + matrix[:3, 3])
        corners = one.neutral.corners.reshape(-1, 3) + made[-1][1]
        # a mirror turns the surface inside out
        triangles.append(corners[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else corners)
        if len(one.neutral.colours):
            colours.append(one.neutral.colours)
        size = sum(map(len, vertices)) + sum(len(part.deltas.vertices) for part, *_ in made)
        if size > file.path.stat().st_size:
            message = "its meshes together move more vertices than the file can hold"
            raise errors.InputError(file.path, f"{message}: {glb.AGAIN}")
    neutral = _pose(
        np.concatenate(vertices),
        np.concatenate(triangles),
        np.concatenate(colours if len(colours) == len(made) else [np.zeros((0, 3))]),
    )
    _check_finite(file, neutral.coordinates, "the joined mesh")
    names = list(dict.fromkeys(name for one, *_ in made for name in one.names))
    if len(names) > MOST_TARGETS:
        message = f"has {len(names)} morph targets, at most {MOST_TARGETS} are read"
        raise errors.InputError(file.path, f"{message}: leave some out")
    called = ", ".join(str(mesh.name or "unnamed") for mesh, _ in placed)
    notes = [f"{len(made)} meshes are joined as the scene puts them: {called:.200}"]
    notes += [note for one, *_ in made for note in one.notes]
    notes += [note for mesh, _ in placed for note in _resting(mesh)]
    deltas = _merged(made, names, len(neutral.coordinates))
    return GlbRig(neutral, names, local_shapes.gather(deltas), notes)


def _merged(
    made: list[tuple[GlbRig, int, np.ndarray]], names: list[str], count: int
) -> Iterator[np.ndarray]:
    """Yield the differences (V, 3) of each name over all meshes; each stands from a vertex on."""
    places = [{name: shape for shape, name in enumerate(one.names)} for one, *_ in made]
    for name in names:
        delta = np.zeros((count, 3))
        for (one, start, linear), shapes in zip(made, places, strict=True):
            if name in shapes:
                shape = shapes[name]
                rows = slice(one.deltas.first[shape], one.deltas.first[shape + 1])
                delta[start + one.deltas.vertices[rows]] = one.deltas.values[rows] @ linear.T
        yield delta


def _morphed(file: glb.Glb) -> dict[int, gltf.Mesh]:
    """Return the meshes that have morph targets, by their numbers."""
    meshes = {i: mesh for i, mesh in enumerate(file.document.meshes or []) if mesh is not None}
    found = {
        number: mesh
        for number, mesh in meshes.items()
        if any(part.targets for part in mesh.primitives or [])
    }
    if not found:
        message = "has no morph targets: export the mesh with its shape keys, or an OBJ each shape"
        raise errors.InputError(file.path, message)
    return found


def _attribute(attributes: object, name: str) -> object:
    """Return the accessor of an attribute, or None; pygltflib gives objects or dictionaries."""
    if isinstance(attributes, dict):
        return attributes.get(name)
    return getattr(attributes, name, None)


def _surfaces(
    file: glb.Glb, parts: list[gltf.Primitive]
) -> tuple[dict[str, tuple], np.ndarray, np.ndarray, np.ndarray]:
    """Return the primitives without repeats, and vertices, triangles and colours of all joined."""
    bases, starts, vertices, triangles, colours = {}, {}, [], [], []
    for number, part in enumerate(parts):
        glb.refuse_compressed(file.path, part.extensions)
        position = _attribute(part.attributes, "POSITION")
        targets = part.targets or []
        key = str((position, [_attribute(target, "POSITION") for target in targets]))
        if key not in bases:
            points = glb.values(file, position, POINT)
            _check_finite(file, points, f"primitive {number}")
            starts[key] = sum(map(len, vertices))
            bases[key] = (len(points), targets)
            vertices.append(points)
            colour = _attribute(part.attributes, "COLOR_0")
            if colour is not None:
                colours.append(glb.values(file, colour, COLOUR, len(points))[:, :3])
        triangles.append(_triangles(file, number, part, bases[key][0]) + starts[key])
        if sum(map(len, vertices)) + sum(map(len, triangles)) > len(file.binary):
            message = f"primitives up to {number} have more vertices than the file can hold"
            raise errors.InputError(file.path, f"{message}: {glb.AGAIN}")
    whole = colours if len(colours) == len(vertices) else [np.zeros((0, 3))]
    shown = srgb.encoded(np.clip(np.concatenate(whole), 0.0, 1.0))
    return bases, np.concatenate(vertices), np.concatenate(triangles), shown


def _triangles(file: glb.Glb, number: int, part: gltf.Primitive, count: int) -> np.ndarray:
    """Return the triangles (N, 3) of a primitive."""
    if part.mode not in (None, gltf.TRIANGLES):
        message = f"primitive {number} is drawn in mode {part.mode!r:.20}, not in triangles"
        raise errors.InputError(file.path, f"{message}: export it as triangles")
    flat = np.arange(count) if part.indices is None else glb.whole_numbers(file, part.indices)
    if len(flat) % 3 or (flat >= count).any():
        message = f"primitive {number} has triangles beyond its {count} vertices, or a part of one"
        raise errors.InputError(file.path, f"{message}: {glb.AGAIN}")
    return flat.reshape(-1, 3)


def _deltas(file: glb.Glb, bases: list[tuple], count: int) -> Iterator[np.ndarray]:
    """Yield the differences (V, 3) of each shape; refuse more of them than the file can hold."""
    moved, size = 0, file.path.stat().st_size
    for shape in range(count):
        rows = []
        for vertices, targets in bases:
            accessor = _attribute(targets[shape], "POSITION")
            still = np.zeros((vertices, 3))
            rows.append(still if accessor is None else glb.values(file, accessor, POINT, vertices))
        delta = np.concatenate(rows)
        _check_finite(file, delta, f"morph target {shape}")
        moved += np.count_nonzero(delta.any(axis=1))
        if moved > size:  # a vertex takes four bytes at least, unless its data is used many times
            message = f"morph targets up to {shape} move more vertices than the file can hold"
            raise errors.InputError(file.path, f"{message}: {glb.AGAIN}")
        yield delta


def _check_finite(file: glb.Glb, values: np.ndarray, what: str) -> None:
    """Refuse coordinates that are no numbers, and surfaces without any."""
    if not len(values):
        raise errors.InputError(file.path, f"{what} has no vertices: {glb.AGAIN}")
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(bad):
        message = f"{what}, vertex {bad[0]}: is not finite: repair it and export again"
        raise errors.InputError(file.path, message)


def _names(file: glb.Glb, mesh: gltf.Mesh, count: int) -> tuple[list[str], list[str]]:
    """Return the shapes' names, made such as rigs allow, and what was changed."""
    given = (mesh.extras if isinstance(mesh.extras, dict) else {}).get("targetNames")
    if given is None:
        return [f"target_{shape}" for shape in range(count)], [
            "has no names of shapes (targetNames): they are called target_0, target_1 ..."
        ]
    if not isinstance(given, list) or len(given) != count:
        found = len(given) if isinstance(given, list) else 0
        message = f"its targetNames are {found}, its morph targets {count}: {glb.AGAIN}"
        raise errors.InputError(file.path, message)
    names, notes = [], []
    for shape, old in enumerate(given):
        text = str(old).encode("utf-8", "replace").decode("utf-8")
        plain = re.sub(r"[.:/\\\s\x00-\x1f\x7f]+", "_", text).strip("_") or f"target_{shape}"
        name, again = plain, 2
        while name in names:
            name, again = f"{plain}_{again}", again + 1
        names.append(name)
        if name != old:
            notes.append(f"shape {shape} '{text:.60}' is called {name}")
    return names, notes


def _moved(file: glb.Glb, number: int) -> list[str]:
    """Say which node moves the mesh, or one above it: its transform is not applied."""
    nodes = file.document.nodes or []
    parents = {}
    for place, node in enumerate(nodes):
        for child in getattr(node, "children", None) or []:
            parents[str(child)] = place
    for start, node in enumerate(nodes):
        if getattr(node, "mesh", None) != number:
            continue
        place, seen = start, set()
        while place is not None and place not in seen:
            seen.add(place)
            for name, rest in REST.items():
                value = getattr(nodes[place], name, None)
                if value not in (None, [], rest):
                    what = f"node {place} has a {name} {value!s:.60}, which is not applied"
                    return [f"{what}: unit, axes and pivot are those of the mesh itself"]
            place = parents.get(str(place))
    return []


def _resting(mesh: gltf.Mesh) -> list[str]:
    """Say that the file shows its mesh with shapes turned on."""
    if not isinstance(mesh.weights, list) or not any(mesh.weights):
        return []
    return ["rests with morph targets turned on: the neutral is the mesh with all of them at 0"]
