import numpy as np
import pytest

from stages.files import actor_masks, delimited, errors

POINTS = ["brow_00", "brow_01", "lips_00", "lips_01", "CHIN", "LID"]


def read(folder, rows, points=POINTS, known=()):
    path = folder / "actor_masks.tsv"
    table = [("ada", *row) for row in rows] + [("mia", "face", "*", "")]
    delimited.write(path, ("actor", "mask", "point", "weight"), table)
    return actor_masks.read(path, "ada", points, known)


def test_contours_points_and_the_rest(tmp_path):
    rows = [
        ("upper", "*", ""),
        ("mouth", "lips", ""),
        ("mouth", "CHIN", "0.75"),
        ("mouth", "lips_01", "0.5"),
        ("eyes", "LID", "1"),
    ]
    masks = read(tmp_path, rows)
    assert masks.names == ["upper", "mouth", "eyes"]
    expected = [[1, 1, 0, 0.5, 0.25, 0], [0, 0, 1, 0.5, 0.75, 0], [0, 0, 0, 0, 0, 1]]
    np.testing.assert_allclose(masks.weights, expected)


def test_rows_may_name_points_that_do_not_drive(tmp_path):
    rows = [("upper", "*", ""), ("mouth", "lips", ""), ("mouth", "JAW", "")]
    masks = read(tmp_path, rows, POINTS[:4], ["JAW"])
    np.testing.assert_allclose(masks.weights, [[1, 1, 0, 0], [0, 0, 1, 1]])


def test_a_weight_of_zero_alone_leaves_a_point_out(tmp_path):
    """Under the mask of all others, too; beside another weight it says nothing."""
    rows = [("upper", "*", ""), ("upper", "brow", "0"), ("mouth", "lips", ""), ("mouth", "LID", "")]
    masks = read(tmp_path, [*rows, ("upper", "lips_00", "0")])
    np.testing.assert_allclose(masks.weights, [[0, 0, 0, 0, 1, 0], [0, 0, 1, 1, 0, 1]])
    rows += [("mouth", "CHIN", "0"), ("mouth", "lips_01", "0.75")]
    masks = read(tmp_path, rows)
    np.testing.assert_allclose(masks.weights, [[0, 0, 0, 0.25, 0, 0], [0, 0, 1, 0.75, 0, 1]])


def test_thirds_are_one(tmp_path):
    masks = read(tmp_path, [(mask, point, "0.3333") for mask in "abc" for point in POINTS])
    np.testing.assert_allclose(masks.weights.sum(axis=0), 1, rtol=1e-12)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([], "has no row for actor ada: say which points belong to which mask"),
        ([("a", "*", ""), ("b", "nose", "")], "line 3, column point: ada has no point, marker or "
         "contour 'nose': correct"),
        ([("a", "lips", "")], "the masks of ada leave 4 points out, brow_00, brow_01, CHIN, LID: "),
        ([("a", "*", ""), ("a", "*", "")], "line 3: \\* stands twice in mask a"),
        ([("a", "*", ""), ("b", "*", "")], "\\* stands in a and b of ada: leave it to one mask"),
        ([("a", "*", ""), ("b", "lips", ""), ("c", "lips_01", "0.5")],
         "sum to 1.5 at lips_01 \\(b 1, c 0.5\\): make it 1"),
        ([("a", "*", "0.5"), ("a", "LID", "0.5"), ("b", "lips", "")],
         "the masks of ada sum to 0.5 at LID \\(a 0.5\\)"),
        ([("a", "*", ""), ("b", "LID", "x")], "line 3, column weight: 'x' is not a number"),
        ([("a", "*", ""), ("b", "LID", "-1")], "line 3, column weight: -1 is not within 0 and 1"),
        ([("a", "*", ""), ("b", "LID", "0")], "mask b of ada has none of the 5 points that drive"),
    ],
)  # fmt: skip
def test_bad_masks_are_named(tmp_path, rows, message):
    with pytest.raises(errors.InputError, match=rf"actor_masks\.tsv: .*{message}"):
        read(tmp_path, rows)
