"""The shipped maps of landmarks, and the point sets and regions that go with them."""

import other_trackers
import pytest

from stages.files import landmark_map, point_set, regions

TRACKERS = sorted(other_trackers.MAPS_OF)


@pytest.mark.parametrize("tracker", TRACKERS)
def test_a_map_fits_its_point_set_and_regions(tracker):
    indices = other_trackers.MAPS_OF[tracker]
    assert len(set(indices.values())) == len(indices)
    contours = point_set.read(other_trackers.TABLES / "point_sets" / f"{tracker}.tsv")
    names = [name for one in contours for name in point_set.point_names(one, one.count)]
    assert names == list(indices)
    table = regions.read(other_trackers.TABLES / "regions" / f"{tracker}.tsv")
    known = {contour.name for contour in contours}
    assert {point for members in table.values() for point in members} == known


def test_the_68_points_follow_the_meshs_contours_in_its_order():
    """Side, start and direction of every contour are the same in both maps."""
    mesh = {index: name for name, index in other_trackers.MAPS_OF["mediapipe"].items()}
    followed: dict[str, list[int]] = {}
    for name, index in other_trackers.MAPS_OF["ibug68"].items():
        contour = point_set.contour_of(name)
        counterpart = mesh[other_trackers.IBUG[index]]
        assert point_set.contour_of(counterpart) == contour
        followed.setdefault(contour, []).append(int(counterpart.rpartition("_")[2]))
    for places in followed.values():
        assert places[0] == 0 and places == sorted(set(places))


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("index\tpoint\n1\ta\n2\ta\n", "line 3, column point: 'a' is blank, stands twice"),
        ("index\tpoint\n1\ta.b\n", "line 2, column point: 'a.b'"),
        ("index\tpoint\n-1\ta\n", "line 2, column index: '-1' is not a whole number"),
        ("index\tpoint\n", "names no point"),
    ],
)
def test_faulty_maps_are_named(tmp_path, text, fault):
    path = tmp_path / "mediapipe.tsv"
    path.write_text(text)
    with pytest.raises(ValueError, match=rf"mediapipe\.tsv: {fault}"):
        landmark_map.read(path)
    with pytest.raises(ValueError, match=r"a\.csv: holds points of ibug68.* given are mediapipe"):
        landmark_map.choose([str(path)], ["ibug68"], "a.csv")
