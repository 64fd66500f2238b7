import json
import logging
import struct
import warnings
from fractions import Fraction

import numpy as np
import pygltflib
import pytest
from glb_maker import DELTAS, FACES, NEUTRAL, Maker, save
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stages import assemble_blendshapes
from stages.core import local_shapes, srgb, take_motion
from stages.files import errors, glb_rig, gltf, rig


def check(found, names=("jawOpen", "eyeBlink_L")):
    assert found.names == list(names)
    np.testing.assert_array_equal(found.neutral.coordinates, NEUTRAL)
    np.testing.assert_array_equal(local_shapes.dense(found.deltas), DELTAS)


def test_what_the_projects_own_writer_makes_comes_back(tmp_path):
    colours = np.random.default_rng(1).uniform(size=(6, 3))
    shapes = local_shapes.gather(DELTAS)
    character = rig.Rig(
        ["face.a", "face.b"], ["face"], [], NEUTRAL.astype(float), shapes, np.ones((1, 6)),
        np.zeros(2, int), np.full(3, 3), FACES.ravel(), colours, np.zeros(3), "cm", "y", 6.0,
    )  # fmt: skip
    surface = gltf.Surface(FACES, np.tile([0, 0, 1.0], (6, 1)), ["a", "b"], np.ones(2), shapes)
    still = np.tile([0, 0, 0, 1.0], (2, 1))
    motion = take_motion.TakeMotion(np.zeros((2, 2)), still, np.zeros((2, 3)), np.ones(2))
    path = tmp_path / "mesh.glb"
    gltf.write(path, character, surface, motion, np.arange(2), Fraction(25))
    found = glb_rig.read(path)
    check(found, ["a", "b"])
    np.testing.assert_array_equal(found.neutral.corners, FACES.ravel())
    np.testing.assert_allclose(found.neutral.colours, colours, atol=1e-6)
    assert any("has a scale" in note for note in found.notes)


def test_what_pygltflib_writes_is_read(tmp_path):
    made = Maker()
    part = made.part(faces=FACES)
    document = pygltflib.GLTF2().from_json(json.dumps(made.document([part])))
    document.set_binary_blob(made.blob)
    document.save_binary(str(tmp_path / "a.glb"))
    check(glb_rig.read(tmp_path / "a.glb"))


@pytest.mark.parametrize("sparse", [False, True])
def test_primitives_are_joined_in_their_order(tmp_path, sparse):
    made = Maker()
    parts = [
        made.part(slice(0, 3), FACES[:1], sparse),
        made.part(slice(3, 6), np.array([[0, 1, 2]]), sparse),
    ]
    found = glb_rig.read(save(tmp_path / "a.glb", made.document(parts), made.blob))
    check(found)
    assert found.neutral.corners.tolist() == [0, 1, 2, 3, 4, 5]
    assert found.notes == []


def test_primitives_that_share_their_vertices_have_them_once(tmp_path):
    made = Maker()
    part = made.part(faces=FACES[:2])
    other = part | {"indices": made.add(FACES[2:].ravel().astype("<u4"), 5125)}
    found = glb_rig.read(save(tmp_path / "a.glb", made.document([part, other]), made.blob))
    check(found)
    np.testing.assert_array_equal(found.neutral.corners, FACES.ravel())


def test_quantised_numbers_stand_for_what_they_say(tmp_path):
    made = Maker()
    stored = np.array([[32767, -32768, 1, 0], [0, 5, -7, 0], [1, 2, 3, 0]], "<i2")
    kept = np.array([[0, 0, 127, 0], [1, 2, -128, 0], [0, 0, 0, 0]], "<i1")
    views = made.view(stored, byteStride=8), made.view(kept, byteStride=4)
    for view, kind in zip(views, (5122, 5120), strict=True):
        made.accessors.append(
            {"bufferView": view, "componentType": kind, "count": 3, "type": "VEC3"}
        )
    made.accessors[0]["normalized"] = True
    part = {"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}
    nodes = [{"children": [1], "scale": [2, 2, 2]}, {"mesh": 0}]
    extension = {"extensionsRequired": ["KHR_mesh_quantization"], "nodes": nodes}
    document = made.document([part], names=None, **extension)
    found = glb_rig.read(save(tmp_path / "a.glb", document, made.blob))
    truth = np.maximum(stored[:, :3] / 32767, -1)
    np.testing.assert_allclose(found.neutral.coordinates, truth, atol=1e-12)
    np.testing.assert_array_equal(local_shapes.dense(found.deltas)[0], kept[:, :3])
    assert found.names == ["target_0"]
    assert any("node 0 has a scale [2" in note for note in found.notes)


def test_names_are_made_legal_and_unlike(tmp_path):
    made = Maker()
    names = ["head.jaw open:1", "head_jaw/open 1"]
    found = glb_rig.read(save(tmp_path / "a.glb", made.document([made.part()], names), made.blob))
    check(found, ["head_jaw_open_1", "head_jaw_open_1_2"])
    assert "'head.jaw open:1' is called head_jaw_open_1" in found.notes[0]


def faulty(made, part, document, fault):
    accessors, views = made.accessors, made.views
    base = accessors[part["attributes"]["POSITION"]]
    cyclic = [{"children": [1], "mesh": 0}, {"children": [0]}]
    big = {"count": 4_000_000_000}
    changes = {
        "beyond": lambda: base.update(byteOffset=40),
        "count": lambda: base.update(big),
        "view": lambda: views[base["bufferView"]].update(byteLength=4_000_000_000),
        "no data": lambda: (base.update(big), base.pop("bufferView")),
        "accessor": lambda: part["attributes"].update(POSITION=99),
        "negative": lambda: base.update(byteOffset=-4),
        "text": lambda: base.update(count="many"),
        "component": lambda: base.update(componentType=5124),
        "type": lambda: base.update(type="VEC2"),
        "target rows": lambda: accessors[0].update(count=3),
        "outside": lambda: document["buffers"][0].update(uri="a.bin"),
        "no targets": lambda: part.pop("targets"),
        "two meshes": lambda: document["meshes"].append(document["meshes"][0]),
        "strip": lambda: part.update(mode=5),
        "indices": lambda: part.update(indices=part["attributes"]["POSITION"]),
        "names": lambda: document["meshes"][0]["extras"].update(targetNames=["one"]),
        "meshopt": lambda: views[0].update(extensions={"EXT_meshopt_compression": {"count": 1}}),
        "draco": lambda: document.update(extensionsRequired=["KHR_draco_mesh_compression"]),
        "cyclic": lambda: document.update(nodes=cyclic, scenes=[{"nodes": [0]}]),
        "many": lambda: part.update(targets=part["targets"] * 3000),
    }
    changes[fault]()
    return document


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("beyond", r"accessor 2 reaches beyond its data"),
        ("count", r"accessor 2 reaches beyond its data: 4000000000 elements"),
        ("view", "the file's data at"),
        ("no data", "claims 4000000000 elements and has no data"),
        ("accessor", "names accessor 99, the file has 3"),
        ("negative", "the offset of accessor 2 is -4, no whole number"),
        ("text", "its JSON chunk is no glTF document"),
        ("component", "components of type 5124"),
        ("type", "is of type 'VEC2', expected VEC3"),
        ("target rows", "accessor 0 has 3 elements, expected 6"),
        ("outside", "outside its binary chunk"),
        ("no targets", "has no morph targets"),
        ("two meshes", "mesh 1 stands 0 times in the scene, expected once"),
        ("strip", "drawn in mode 5"),
        ("indices", "is of type 'VEC3', expected SCALAR"),
        ("names", "its targetNames are 1, its morph targets 2"),
        ("meshopt", r"is compressed by meshopt \(EXT_meshopt_compression\)"),
        ("draco", r"is compressed by Draco \(KHR_draco_mesh_compression\)"),
        ("many", "has 6000 morph targets"),
    ],
)
def test_hostile_files_end_in_one_line(tmp_path, fault, message):
    made = Maker()
    part = made.part()
    document = faulty(made, part, made.document([part]), fault)
    path = save(tmp_path / "a.glb", document, made.blob)
    with pytest.raises(errors.InputError, match=message) as caught:
        glb_rig.read(path)
    assert str(caught.value).startswith(f"{path}: ") and "\n" not in str(caught.value)


def test_data_used_again_and_again_is_refused_before_it_fills_the_memory(tmp_path):
    made = Maker()
    part = made.part()
    part["targets"] = part["targets"][:1] * 4000
    document = made.document([part], names=None)
    path = save(tmp_path / "a.glb", document, made.blob)
    found = glb_rig.read(path)  # small: the JSON itself is as long as what it asks for
    assert len(found.names) == 4000
    part["targets"] = [{"POSITION": made.add(np.ones((60_000, 3), "<f4"))}] * 200
    part["attributes"]["POSITION"] = len(made.accessors) - 1
    path = save(tmp_path / "a.glb", made.document([part], names=None), made.blob)
    with pytest.raises(errors.InputError, match="move more vertices than the file can hold"):
        glb_rig.read(path)


def test_cyclic_nodes_end(tmp_path):
    made = Maker()
    part = made.part()
    document = faulty(made, part, made.document([part]), "cyclic")
    check(glb_rig.read(save(tmp_path / "a.glb", document, made.blob)))


def test_a_claim_of_four_gigabytes_is_refused(tmp_path):
    path = tmp_path / "a.glb"
    path.write_bytes(struct.pack("<IIIII", 0x46546C67, 2, 0xFFFFFFFF, 0xFFFFFFF0, 0x4E4F534A))
    with pytest.raises(errors.InputError, match="claims 4294967295 bytes and has 20"):
        glb_rig.read(path)
    path.write_bytes(struct.pack("<IIIII", 0x46546C67, 2, 20, 0xFFFFFFF0, 0x4E4F534A))
    with pytest.raises(errors.InputError, match="the chunk at byte 12 claims 4294967280 bytes"):
        glb_rig.read(path)


def test_a_file_cut_short_anywhere_is_refused(tmp_path):
    made = Maker()
    data = save(tmp_path / "a.glb", made.document([made.part()]), made.blob).read_bytes()
    path = tmp_path / "b.glb"
    for length in range(0, len(data), 7):
        path.write_bytes(data[:length])
        with pytest.raises(errors.InputError, match="b.glb: "):
            glb_rig.read(path)


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_damage_anywhere_is_a_rig_or_one_line(tmp_path, data):
    made = Maker()
    whole = save(
        tmp_path / "a.glb", made.document([made.part(faces=FACES, sparse=True)]), made.blob
    ).read_bytes()
    place = data.draw(st.integers(0, len(whole) - 1))
    other = data.draw(st.sampled_from(b'0129[]{}",:nte-\x00\xff'))
    (tmp_path / "b.glb").write_bytes(whole[:place] + bytes([other]) + whole[place + 1 :])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            glb_rig.read(tmp_path / "b.glb")
        except errors.InputError as error:
            assert "\n" not in str(error)


def test_the_stage_makes_a_rig_of_it(tmp_path, caplog):
    made = Maker()
    path = save(tmp_path / "a.glb", made.document([made.part(faces=FACES)]), made.blob)
    argv = ["--neutral", str(path), "--shapes", "--shape-folder", str(tmp_path / "shapes")]
    argv += ["--unit", "m", "--up-axis", "y", "--pivot", "0 0 0", "--face-unit", "0.06"]
    with caplog.at_level(logging.WARNING):
        assemble_blendshapes.main([*argv, "--rig", str(tmp_path / "rig.npz")])
    assert not caplog.records
    found = rig.read(tmp_path / "rig.npz", "mesh")
    assert found.names == ["face.jawOpen", "face.eyeBlink_L"]
    np.testing.assert_array_equal(local_shapes.dense(found.deltas), DELTAS)
    np.testing.assert_array_equal(found.corners, FACES.ravel())


def test_light_and_colour_are_each_others_inverse():
    colours = np.linspace(0, 1, 257)
    np.testing.assert_allclose(srgb.encoded(srgb.linear(colours)), colours, atol=1e-7)
