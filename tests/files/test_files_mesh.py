import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from stages.files import errors, mesh, obj

SEAMED = """\
# an unreferenced vertex first, quads and a pentagon, texture seams, a colour for each
mtllib none.mtl
o face
v 9 9 9 0.1 0.2 0.3
v 0 0 0 1 0 0
v 1 0 0 1 0 0
v 1 1 0 1 0 0
v 0 1 0 1 0 0
v 0.5 1.5 \\
  0 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vt 0.9 0.1
vn 0 0 1
f 2/1/1 3/2/1 4/3/1 5/4/1
f 2/5/1 3/5/1 4/5/1 6/5/1 5/5/1
f -1//1 -2//1 -3//1
v 4 4 4 0 0 1
"""


def test_order_count_polygons_and_colours_are_the_files_to_the_letter(tmp_path):
    path = tmp_path / "seamed.obj"
    path.write_text(SEAMED)
    read = mesh.read(path)
    expected = [[9, 9, 9], [0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 1.5, 0], [4, 4, 4]]
    np.testing.assert_array_equal(read.vertices, expected)
    np.testing.assert_array_equal(read.sizes, [4, 5, 3])
    np.testing.assert_array_equal(read.corners, [1, 2, 3, 4, 1, 2, 3, 5, 4, 5, 4, 3])
    np.testing.assert_array_equal(read.colours[[0, 1, 6]], [[0.1, 0.2, 0.3], [1, 0, 0], [0, 0, 1]])


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_trimesh_cannot_keep_that_order_which_is_why_it_is_not_used(tmp_path):
    path = tmp_path / "seamed.obj"
    path.write_text(SEAMED)
    loaded = trimesh.load(path, process=False, maintain_order=True)
    assert len(loaded.vertices) != len(mesh.read(path).vertices)


@given(st.integers(0, 2**32 - 1), st.integers(3, 30))
def test_what_trimesh_writes_is_read_as_it_was(tmp_path_factory, seed, count):
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(count, 3)) * 10.0 ** rng.integers(-3, 4)
    faces = rng.permuted(np.tile(np.arange(count), (5, 1)), axis=1)[:, :3]
    colours = rng.integers(0, 256, (count, 4), dtype=np.uint8)
    made = trimesh.Trimesh(vertices, faces, vertex_colors=colours, process=False)
    folder = tmp_path_factory.mktemp("meshes")
    for name, options in (
        ("a.obj", {"digits": 12}),
        ("b.ply", {}),
        ("c.ply", {"encoding": "ascii"}),
    ):
        made.export(folder / name, **options)
        read = mesh.read(folder / name)
        np.testing.assert_allclose(read.vertices, vertices, rtol=1e-6, atol=1e-8)
        np.testing.assert_array_equal(read.corners.reshape(-1, 3), faces)
        np.testing.assert_array_equal(read.sizes, 3)
        np.testing.assert_allclose(read.colours, colours[:, :3] / 255, atol=1e-6)


def test_a_ply_with_quads_in_big_endian_is_read(tmp_path):
    header = (
        "ply\nformat binary_big_endian 1.0\ncomment by hand\nelement vertex 4\nproperty double x\n"
        "property double y\nproperty double z\nelement face 1\n"
        "property list uchar int vertex_index\nproperty uchar flags\nend_header\n"
    )
    corners = np.arange(12).astype(">f8").tobytes()
    face = b"\x04" + np.array([3, 2, 1, 0], ">i4").tobytes() + b"\x01"
    path = tmp_path / "quad.ply"
    path.write_bytes(header.encode() + corners + face)
    read = mesh.read(path)
    np.testing.assert_array_equal(read.vertices, np.arange(12).reshape(4, 3))
    np.testing.assert_array_equal(read.corners, [3, 2, 1, 0])
    path.write_bytes(path.read_bytes()[:-8])
    with pytest.raises(errors.InputError, match=r"quad\.ply: element face is cut short"):
        mesh.read(path)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.obj", "v 0 0 0\nv 0 nan 0\n", "vertex 1 is '0 nan 0', not finite"),
        ("a.obj", "v 0 0 0\nv 0 inf 0\n", "vertex 1"),
        ("a.obj", "v 0 0 0 1 nan 0\n", "the colour of vertex 0 is not finite: paint it"),
        ("a.obj", "v 0 0 0\nv 0,5 1 2\n", "line 2: 'v 0,5 1 2' holds no numbers.*decimal"),
        ("a.obj", "v 0 0\n", "line 1: a vertex has 2 numbers"),
        ("a.obj", "", "has no vertices"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "face 0 names vertex 8, the file has 3"),
        ("a.obj", "v 0 0 0\nf 1 2 -4\n", "line 2.*above the first"),
        ("a.obj", "v 0 0 0\nf 0 1 1\n", "line 2.*counted from 1"),
        ("a.obj", "v 0 0 0\nf 1 1\n", "line 2.*no face"),
        ("a.obj", "v 0 0 0\nf a b c\n", "line 2.*no face"),
        ("a.ply", "v 0 0 0\n", "no PLY header"),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex x\n", "line 3.*no PLY header"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
            "no property y",
        ),
        ("a.stl", "solid\n", "no mesh format"),
    ],
)
def test_bad_meshes_are_named_with_place_and_cure(tmp_path, name, text, message):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(errors.InputError, match=message) as caught:
        mesh.read(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_a_missing_mesh_is_named(tmp_path):
    with pytest.raises(errors.InputError, match="no such mesh"):
        mesh.read(tmp_path / "gone.obj")


def test_colours_count_only_if_every_vertex_has_one(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0 1 1 1\nv 0 0 1\nv 0 1 0 1.0\n")
    assert obj.read(path)[3] == []
    assert mesh.read(path).colours.shape == (0, 3)


def test_colours_up_to_255_are_brought_to_one(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0 255 0 51\nv 0 0 1 0 0 0\n")
    np.testing.assert_allclose(mesh.read(path).colours, [[1, 0, 0.2], [0, 0, 0]])
