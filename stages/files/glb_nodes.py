"""Where the scene of a GLB file puts its meshes."""

import numpy as np

from stages.files import errors, glb

DEEPEST = 256


def placed(file: glb.Glb, numbers: list[int]) -> list[tuple[int, np.ndarray]]:
    """Return the meshes that the scene shows and the matrix (4, 4) of each, in the scene's order.

    Meshes that one skin moves stay in their own space, which is the skin's: glTF has viewers ignore
    their nodes.

    Parameters
    ----------
    file : the file
    numbers : meshes to look for

    Raises
    ------
    errors.InputError
        if one is shown twice or not at all, some have a skin and others none or another, or a node
        is damaged
    """
    found = _shown(file, numbers)
    for number in numbers:
        shown = sum(mesh == number for mesh, *_ in found)
        if shown != 1:
            what = f"mesh {number} stands {shown} times in the scene, expected once"
            raise errors.InputError(file.path, f"{what}: join the meshes into one")
    skins = {skin for *_, skin in found}
    if skins == {str(None)}:
        return [(mesh, matrix) for mesh, matrix, _ in found]
    if len(skins) > 1:
        message = "has meshes with morph targets under unlike skins: join them into one"
        raise errors.InputError(file.path, message)
    return [(mesh, np.eye(4)) for mesh, *_ in found]


def _shown(file: glb.Glb, numbers: list[int]) -> list[tuple[int, np.ndarray, str]]:
    """Return mesh, matrix and skin of the nodes that hold one of the meshes, scene by its tree."""
    nodes = file.document.nodes or []
    seen, found = set(), []
    waiting = [(root, np.eye(4), 0) for root in reversed(_roots(file))]
    while waiting:
        number, above, depth = waiting.pop()
        node = glb.item(file.path, nodes, number, "node")
        if number in seen or depth > DEEPEST:
            message = f"node {number} stands twice in the scene, or {DEEPEST} nodes deep"
            raise errors.InputError(file.path, f"{message}: {glb.AGAIN}")
        seen.add(number)
        matrix = above @ _local(file, number, node)
        if node.mesh is not None and node.mesh in numbers:
            found.append((node.mesh, matrix, str(node.skin)))
        children = _numbers(file, node.children, f"children of node {number}")
        waiting += [(child, matrix, depth + 1) for child in reversed(children)]
    return found


def _roots(file: glb.Glb) -> list[object]:
    """Return the first nodes of the file's scene."""
    document = file.document
    if document.scenes:
        scene = glb.item(file.path, document.scenes, document.scene or 0, "scene")
        return _numbers(file, scene.nodes, "nodes of the scene")
    nodes = document.nodes or []
    children = [_numbers(file, node.children, "children of a node") for node in nodes if node]
    below = {str(child) for some in children for child in some}
    return [number for number in range(len(nodes)) if str(number) not in below]


def _numbers(file: glb.Glb, value: object, what: str) -> list[object]:
    """Return a list, which JSON may hold anything in place of."""
    if value is not None and not isinstance(value, list):
        raise errors.InputError(file.path, f"the {what} are no list: {glb.AGAIN}")
    return list(value or [])


def _local(file: glb.Glb, number: object, node: object) -> np.ndarray:
    """Return the matrix (4, 4) of a node within the one above it."""
    given = {name: getattr(node, name) for name in ("matrix", "translation", "rotation", "scale")}
    sizes = {"matrix": 16, "translation": 3, "rotation": 4, "scale": 3}
    values = {}
    for name, value in given.items():
        if value is None or (name == "matrix" and not len(value)):
            continue
        try:
            values[name] = np.array(value, float)
        except (TypeError, ValueError):
            values[name] = np.zeros(0)
        if values[name].shape != (sizes[name],) or not (np.abs(values[name]) < 1e30).all():
            message = f"node {number} has a {name} that is not {sizes[name]} numbers"
            raise errors.InputError(file.path, f"{message}: {glb.AGAIN}")
    if "matrix" in values:
        return values["matrix"].reshape(4, 4).T
    found = np.eye(4)
    x, y, z, w = values.get("rotation", np.array([0.0, 0.0, 0.0, 1.0]))
    found[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    found[:3, :3] *= values.get("scale", np.ones(3))
    found[:3, 3] = values.get("translation", np.zeros(3))
    return found
