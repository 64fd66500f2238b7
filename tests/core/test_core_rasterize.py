import numpy as np
import pytest

from stages.core import head_transform, rasterize, shade

SIDE = 96
RED, GREEN, BLUE, WHITE = [1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0], [1.0, 1.0, 1.0]


def picture(vertices, triangles, colours, up="y"):
    """Draw from before the face, with a camera round the box from -1 to 1."""
    axes = head_transform.face_axes(up)
    camera = rasterize.facing_camera(-np.ones(3), np.ones(3), axes)
    return rasterize.draw(
        np.array(vertices, np.float32),
        np.array(triangles, np.int32),
        np.array(colours, np.float32),
        camera,
        np.zeros((SIDE, SIDE, 3), np.float32),
    )


def centre(drawn, channel):
    """Return the mean column and row of what is bright in a channel."""
    rows, columns = np.nonzero(drawn[:, :, channel] > 128)
    return columns.mean() - (SIDE - 1) / 2, rows.mean() - (SIDE - 1) / 2


def small_triangle(place):
    place = np.array(place, float)
    return [place, place + np.array([0.2, 0, 0]), place + np.array([0, 0.2, 0.1])]


@pytest.mark.parametrize("up", ["y", "z"])
def test_the_subjects_left_is_at_the_right_and_up_is_up(up):
    axes = head_transform.face_axes(up)
    left, above = axes @ [0.7, 0, 0], axes @ [0, 0.7, 0]
    drawn = picture(
        [*small_triangle(left), *small_triangle(above)],
        [[0, 1, 2], [3, 4, 5]],
        [RED] * 3 + [GREEN] * 3,
        up,
    )
    x, y = centre(drawn, 0)
    assert x > SIDE / 5
    assert abs(y) < SIDE / 10
    x, y = centre(drawn, 1)
    assert y < -SIDE / 5
    assert abs(x) < SIDE / 10


def test_what_is_nearer_hides_what_is_behind_in_any_order_of_drawing():
    square = [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]
    near = [[x, y, 0.5] for x, y, _ in square]
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    for order in ([faces, faces + 4], [faces + 4, faces]):
        drawn = picture(square + near, np.concatenate(order), [RED] * 4 + [BLUE] * 4)
        np.testing.assert_allclose(drawn[SIDE // 2, SIDE // 2], [0, 0, 255], atol=2)


def test_the_box_fills_the_picture_without_leaving_it():
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    faces = [[0, 2, 4], [2, 4, 6], [1, 3, 5], [3, 5, 7], [0, 1, 2], [1, 2, 3], [4, 5, 6], [5, 6, 7]]
    drawn = picture(corners, faces, [WHITE] * 8)[:, :, 0] > 128
    assert not drawn[0].any()
    assert not drawn[:, 0].any()
    assert drawn.any(axis=0).mean() > 0.85


def test_edges_are_soft_and_surfaces_are_not_blurred():
    triangle = [[-0.9, -0.9, 0], [0.9, -0.8, 0], [0.1, 0.9, 0]]
    drawn = picture(triangle, [[0, 1, 2]], [WHITE] * 3)[:, :, 0]
    between = (drawn > 20) & (drawn < 235)
    assert 0.005 < between.mean() < 0.1
    assert (drawn[SIDE // 2 - 5 : SIDE // 2 + 5, SIDE // 2] >= 254).all()


def test_outward_is_told_by_volume_or_by_facing():
    corners = np.array([[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]], float)
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    sheet = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
    back = np.array([0.0, 0.0, 1.0])
    for vertices, triangles in ((corners, faces), (sheet, np.array([[0, 1, 2]]))):
        for sign, turned in ((1, triangles), (-1, triangles[:, ::-1])):
            a, b, c = (vertices[turned[:, i]] for i in range(3))
            assert shade.outward(vertices, turned, np.cross(b - a, c - a), back) == sign


def test_light_comes_from_above_left_and_keeps_the_colours():
    normals = np.array([[-0.5, 0.6, 0.62], [0.3, -0.8, 0.52]])
    lit = shade.vertex_light(normals, np.tile([0.8, 0.5, 0.4], (2, 1)))
    assert (lit[0] > lit[1] + 0.1).all()
    assert (lit[:, 0] > lit[:, 1]).all()
    assert lit.max() <= 1
