"""Rigs of several meshes in one GLB: a head, teeth and eyes, each where the scene puts it."""

import warnings

import numpy as np
import pygltflib
import pytest
from glb_maker import DELTAS, NEUTRAL, Maker, save
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from stages.core import local_shapes
from stages.files import errors, glb_rig

TURN = [0.1, -0.5, 0.3, 0.8062257748298549]
NODES = [
    {"children": [1, 2], "scale": [2.0, 2.0, 2.0], "translation": [0.0, 1.0, 0.0]},
    {"mesh": 0},
    {"children": [3], "rotation": TURN},
    {"mesh": 1, "translation": [1.0, 2.0, 3.0], "scale": [-1.0, 1.0, 1.0]},
]
FACES = np.array([[0, 1, 2], [2, 3, 4]])


def meshes(made, names=(("jawOpen", "eyeBlink_L"), ("tongueOut", "jawOpen"))):
    found = []
    for number, some in enumerate(names):
        part = made.part(faces=FACES)
        mesh = {"name": f"mesh{number}", "primitives": [part]}
        if some:
            mesh["extras"] = {"targetNames": list(some)}
        found.append(mesh)
    return found


def document(made, nodes=NODES, roots=(0,), **more):
    changes = {"nodes": nodes, "meshes": meshes(made), "scenes": [{"nodes": list(roots)}]}
    return made.document([], names=None, **changes | {"scene": 0} | more)


def read_again(path):
    """Return vertices, faces and shapes by name as pygltflib and scipy say the scene is."""
    file = pygltflib.GLTF2().load(str(path))
    blob = file.binary_blob()

    def rows(index):
        accessor = file.accessors[index]
        view = file.bufferViews[accessor.bufferView]
        kind = {5126: "<f4", 5123: "<u2"}[accessor.componentType]
        width = {"VEC3": 3, "SCALAR": 1}[accessor.type]
        return np.frombuffer(blob, kind, accessor.count * width, view.byteOffset).reshape(-1, width)

    parents = {child: number for number, node in enumerate(file.nodes) for child in node.children}
    vertices, faces, shapes, start = [], [], {}, 0
    for number, node in enumerate(file.nodes):
        if node.mesh is None:
            continue
        linear, shift, place = np.eye(3), np.zeros(3), number
        while place is not None:
            above = file.nodes[place]
            turn = Rotation.from_quat(above.rotation or [0, 0, 0, 1]).as_matrix()
            step = turn @ np.diag(above.scale or [1, 1, 1])
            linear, shift = step @ linear, step @ shift + (above.translation or [0, 0, 0])
            place = parents.get(place)
        mesh = file.meshes[node.mesh]
        (part,) = mesh.primitives
        vertices.append(rows(part.attributes.POSITION) @ linear.T + shift)
        faces.append(rows(part.indices).reshape(-1, 3) + start)
        for name, target in zip(mesh.extras["targetNames"], part.targets, strict=True):
            shapes.setdefault(name, np.zeros((12, 3)))[start : start + 6] = (
                rows(target["POSITION"]) @ linear.T
            )
        start += 6
    return np.concatenate(vertices), np.concatenate(faces), shapes


def test_meshes_are_joined_where_the_scene_puts_them(tmp_path):
    made = Maker()
    path = save(tmp_path / "a.glb", document(made), made.blob)
    found = glb_rig.read(path)
    vertices, faces, shapes = read_again(path)
    assert found.names == ["jawOpen", "eyeBlink_L", "tongueOut"] == list(shapes)
    np.testing.assert_allclose(found.neutral.coordinates, vertices, atol=1e-6)
    dense = local_shapes.dense(found.deltas)
    np.testing.assert_allclose(dense, list(shapes.values()), atol=1e-6)
    assert dense[0][:6].any() and dense[0][6:].any()  # jawOpen moves both
    corners = found.neutral.corners.reshape(-1, 3)
    np.testing.assert_array_equal(corners[:2], faces[:2])
    np.testing.assert_array_equal(corners[2:], faces[2:, ::-1])  # the second is mirrored
    assert found.notes == ["2 meshes are joined as the scene puts them: mesh0, mesh1"]


def test_meshes_under_one_skin_stay_in_its_space(tmp_path):
    made = Maker()
    nodes = [dict(node) for node in NODES]
    for node in (nodes[1], nodes[3]):
        node["skin"] = 0
    path = save(tmp_path / "a.glb", document(made, nodes), made.blob)
    found = glb_rig.read(path)
    np.testing.assert_array_equal(found.neutral.coordinates, np.tile(NEUTRAL, (2, 1)))
    dense = local_shapes.dense(found.deltas)
    np.testing.assert_array_equal(dense[2][6:], DELTAS[0])


def test_one_mesh_with_targets_keeps_its_own_space(tmp_path):
    made = Maker()
    changed = document(made)
    changed["meshes"][1]["primitives"][0].pop("targets")
    found = glb_rig.read(save(tmp_path / "a.glb", changed, made.blob))
    np.testing.assert_array_equal(found.neutral.coordinates, NEUTRAL)


def faulty(fault):
    made = Maker()
    nodes = [dict(node) for node in NODES]
    changed = document(made, nodes)
    changes = {
        "names": lambda: changed["meshes"][1].pop("extras"),
        "skins": lambda: nodes[3].update(skin=0),
        "twice": lambda: nodes.append({"mesh": 1}) or nodes[0]["children"].append(4),
        "absent": lambda: nodes[0].update(children=[1]),
        "cyclic": lambda: nodes[3].update(children=[0]),
        "node": lambda: nodes[0].update(children=[1, 2, 77]),
        "matrix": lambda: nodes[2].update(matrix=[1, 2]),
        "huge": lambda: nodes[2].update(scale=[1e300, 1, 1]),
        "scene": lambda: changed.update(scene=5),
    }
    nodes[0]["children"] = list(nodes[0]["children"])
    changes[fault]()
    return made, changed


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("names", "mesh 1 without names of them: name its shapes"),
        ("skins", "under unlike skins"),
        ("twice", "mesh 1 stands 2 times in the scene, expected once"),
        ("absent", "mesh 1 stands 0 times in the scene, expected once"),
        ("cyclic", "node 0 stands twice in the scene"),
        ("node", "names node 77, the file has 4"),
        ("matrix", "node 2 has a matrix that is not 16 numbers"),
        ("huge", "node 2 has a scale that is not 3 numbers"),
        ("scene", "names scene 5, the file has 1"),
    ],
)
def test_what_needs_a_guess_is_refused_in_one_line(tmp_path, fault, message):
    made, changed = faulty(fault)
    path = save(tmp_path / "a.glb", changed, made.blob)
    with pytest.raises(errors.InputError, match=message) as caught:
        glb_rig.read(path)
    assert str(caught.value).startswith(f"{path}: ") and "\n" not in str(caught.value)


def test_meshes_that_use_the_same_data_cannot_fill_the_memory(tmp_path):
    made = Maker()
    count = 200
    part = made.part()
    part["targets"] = [{"POSITION": made.add(np.ones((3000, 3), "<f4"))}] * 2
    part["attributes"]["POSITION"] = len(made.accessors) - 1
    names = {"targetNames": ["a", "b"]}
    shown = [{"primitives": [part], "extras": names} for _ in range(count)]
    nodes = [{"children": list(range(1, count + 1))}, *({"mesh": row} for row in range(count))]
    path = save(tmp_path / "a.glb", document(made, nodes, meshes=shown), made.blob)
    with pytest.raises(errors.InputError, match="more vertices than the file can hold"):
        glb_rig.read(path)


@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_damage_anywhere_is_a_rig_or_one_line(tmp_path, data):
    made = Maker()
    whole = save(tmp_path / "a.glb", document(made), made.blob).read_bytes()
    place = data.draw(st.integers(0, len(whole) - 1))
    other = data.draw(st.sampled_from(b'0129[]{}",:nte-\x00\xff'))
    (tmp_path / "b.glb").write_bytes(whole[:place] + bytes([other]) + whole[place + 1 :])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            glb_rig.read(tmp_path / "b.glb")
        except errors.InputError as error:
            assert "\n" not in str(error)
