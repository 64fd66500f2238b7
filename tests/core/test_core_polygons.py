import numpy as np
import trimesh

from stages.core import polygons


def test_polygons_of_all_sizes_become_fans_in_order():
    sizes = np.array([3, 4, 5, 3])
    corners = np.arange(15)
    expected = [[0, 1, 2], [3, 4, 5], [3, 5, 6], [7, 8, 9], [7, 9, 10], [7, 10, 11], [12, 13, 14]]
    np.testing.assert_array_equal(polygons.triangulate(sizes, corners), expected)
    assert polygons.triangulate(np.zeros(0, int), np.zeros(0, int)).shape == (0, 3)


def test_normals_of_a_ball_point_outwards_as_trimesh_finds_them():
    ball = trimesh.creation.icosphere(subdivisions=2)
    normals = polygons.vertex_normals(ball.vertices, ball.faces)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert (np.sum(normals * ball.vertices, axis=1) > 0.99).all()
    areas = np.linalg.norm(polygons.face_normals(ball.vertices, ball.faces), axis=1) / 2
    np.testing.assert_allclose(areas, ball.area_faces)


def test_a_vertex_without_area_gets_some_normal():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]])
    normals = polygons.vertex_normals(vertices, np.array([[0, 1, 2]]))
    np.testing.assert_allclose(normals, np.tile([0, 0, 1], (4, 1)))
