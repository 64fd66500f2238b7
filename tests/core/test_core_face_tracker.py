import drawn_face
import numpy as np
import pytest

from stages.core import (
    confidence,
    eigen_points,
    face_search,
    face_tracker,
    false_faces,
    similarity,
    tracker_arrays,
    tracker_training,
)

EYES_APART = 44


def error(points, truth):
    return 100 * np.linalg.norm(points - truth, axis=-1).mean() / EYES_APART


def followed(tracker, pictures):
    found, previous = [], None
    for picture in pictures:
        one = face_tracker.track(tracker, picture, previous)
        previous = one.points if one else None
        found.append(one)
    return found


@pytest.fixture(scope="module")
def talk():
    return drawn_face.talking(24)


def test_a_talking_face_is_found_and_followed(drawn_tracker, talk):
    pictures, truth = talk
    found = followed(drawn_tracker, pictures)
    points = np.array([one.points for one in found])
    assert error(points, truth) < 1.0
    mouth = [np.ptp(p[:, -12:, 1], axis=1) for p in (points, truth)]
    assert np.corrcoef(*mouth)[0, 1] > 0.97
    assert np.polyfit(mouth[1], mouth[0], 1)[0] == pytest.approx(1, abs=0.1)


def test_the_refinement_beats_plain_eigen_points(drawn_tracker, talk):
    plain, refined = [], []
    for picture, truth in zip(*talk, strict=True):
        start = similarity.apply(drawn_tracker.frame.pose(truth), drawn_tracker.frame.points)
        points, _ = eigen_points.project(drawn_tracker.eigen, drawn_tracker.frame, picture, start)
        plain.append(error(points, truth))
        refined.append(error(face_tracker.sight(drawn_tracker, picture, start).points, truth))
    assert np.mean(refined) < 0.6 * np.mean(plain)


def test_eigen_points_alone_recover_the_affine_motion_and_the_mouth(drawn_tracker):
    picture, placed = drawn_face.draw(drawn_face.parts(opening=0.8), 0.05, 1.04, (113, 92))
    truth = drawn_face.stacked(placed)
    start = similarity.apply(drawn_tracker.frame.pose(truth), drawn_tracker.frame.points)
    start += (3, -2)
    found, near = eigen_points.project(drawn_tracker.eigen, drawn_tracker.frame, picture, start)
    assert error(found, truth) < 5
    assert error(found, truth) < 0.7 * error(start, truth)
    noise = np.random.default_rng(0).integers(0, 255, picture.shape).astype(np.uint8)
    _, far = eigen_points.project(drawn_tracker.eigen, drawn_tracker.frame, noise, start)
    assert far > 2 * near


def test_the_search_finds_a_face_of_another_size_and_angle(drawn_tracker):
    picture, placed = drawn_face.draw(drawn_face.parts(opening=0.4), 0.25, 0.85, (80, 100))
    truth = drawn_face.stacked(placed)
    found = face_search.search(drawn_tracker.finder, drawn_tracker.frame, picture, 3)
    assert min(error(points, truth) for points in found) < 15


def test_a_cut_is_survived(drawn_tracker, talk):
    later, truth = drawn_face.talking(3, (70.0, 100.0), first=40)
    found = followed(drawn_tracker, [*talk[0][:3], *later])
    assert all(one is not None for one in found)
    assert error(found[-1].points, truth[-1]) < 1.5


def test_a_picture_without_a_face_is_lost_and_the_face_found_again(drawn_tracker, talk):
    empty = np.full_like(talk[0][0], 90)
    noise = np.random.default_rng(1).integers(0, 255, empty.shape).astype(np.uint8)
    found = followed(drawn_tracker, [talk[0][0], empty, noise, talk[0][8]])
    assert [one is None for one in found] == [False, True, True, False]
    assert error(found[-1].points, talk[1][8]) < 1.5


def test_what_a_hand_covers_is_not_trusted(drawn_tracker, talk):
    picture, truth = talk[0][5].copy(), talk[1][5]
    mouth = truth[-24:]
    low, high = (mouth.min(axis=0) - 6).astype(int), (mouth.max(axis=0) + 6).astype(int)
    picture[low[1] : high[1], low[0] : high[0]] = (200, 150, 125)
    found = face_tracker.sight(drawn_tracker, picture, truth)
    assert found.confidence[-24:].max() < 0.5
    clear = face_tracker.sight(drawn_tracker, talk[0][5], truth)
    assert clear.confidence[-24:].min() > 0.5


def test_points_outside_the_picture_have_no_confidence(drawn_tracker):
    picture, placed = drawn_face.draw(drawn_face.parts(), place=(30.0, 95.0))
    found = face_tracker.sight(drawn_tracker, picture, drawn_face.stacked(placed))
    outside = (found.points[:, 0] < 0) | (found.points[:, 0] > drawn_face.WIDTH)
    assert (found.confidence[outside] == 0).all()


def test_packing_and_unpacking_gives_the_same_tracker(drawn_tracker, talk):
    arrays = tracker_arrays.pack(drawn_tracker)
    assert all(isinstance(array, np.ndarray) for array in arrays.values())
    again = tracker_arrays.unpack(arrays)
    first, second = (face_tracker.track(one, talk[0][0], None) for one in (drawn_tracker, again))
    assert np.array_equal(first.points, second.points)
    assert np.array_equal(first.confidence, second.confidence)
    del arrays["judge.basis"]
    with pytest.raises(ValueError, match=r"judge\.basis"):
        tracker_arrays.unpack(arrays)


def test_the_same_seed_gives_the_same_bytes_and_the_baseline_has_no_cascade(drawn_labels):
    pictures, shapes, groups = drawn_labels
    first, second = (
        tracker_training.train(pictures[:3], shapes[:3], groups, "eigen_points", seed=5)
        for _ in range(2)
    )
    assert first.cascade.weights == ()
    packed = [tracker_arrays.pack(one) for one in (first, second)]
    assert all(packed[0][name].tobytes() == packed[1][name].tobytes() for name in packed[0])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"method": "optical_flow"}, "optical_flow is none of"),
        ({"pictures": 2}, "too few"),
        ({"groups": [np.arange(5)]}, "once"),
    ],
)
def test_bad_training_input_is_refused(drawn_labels, change, message):
    pictures, shapes, groups = drawn_labels
    count = change.get("pictures", len(pictures))
    with pytest.raises(ValueError, match=message):
        tracker_training.train(
            pictures[:count],
            shapes[:count],
            change.get("groups", groups),
            change.get("method", "eigen_points"),
            seed=1,
        )


@pytest.mark.parametrize("make", false_faces.KINDS)
def test_false_faces_are_told_from_true_ones(drawn_tracker, drawn_labels, make):
    pictures, shapes, groups = drawn_labels
    rng = np.random.default_rng(9)
    trusted = []
    for picture, shape in zip(pictures, shapes, strict=True):
        image, points, wrong = make(picture, shape, groups, rng)
        seen = tracker_training.described(image, points, drawn_tracker.frame)
        trust, _ = confidence.judge(drawn_tracker.judge, seen, groups)
        trusted.append(trust[wrong])
    assert np.mean(np.concatenate(trusted) > 0.5) < 0.2
