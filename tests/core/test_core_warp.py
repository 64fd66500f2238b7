import cv2
import numpy as np
import pytest

from stages.core import morph, warp


def blob(place, size=(64, 80)):
    """A soft white spot whose centre of mass is the place."""
    y, x = np.mgrid[: size[0], : size[1]] + 0.5
    square = (x - place[0]) ** 2 + (y - place[1]) ** 2
    return (255 * np.exp(-square / 18)).astype(np.float32)


def centre_of_mass(image):
    y, x = np.mgrid[: image.shape[0], : image.shape[1]] + 0.5
    return np.array([(image * x).sum(), (image * y).sum()]) / image.sum()


def test_prewarp_by_whole_pixels_is_a_slice():
    image = np.random.default_rng(0).integers(0, 255, (40, 50, 3)).astype(np.uint8)
    cut = warp.prewarp(image, np.array([[1.0, 0, 7], [0, 1, 4]]), (20, 10))
    assert np.array_equal(cut, image[4:14, 7:27])


def test_prewarp_brings_a_place_to_where_the_inverse_map_says():
    to_image = np.array([[1.2, -0.3, 20.0], [0.3, 1.2, 5.0]])
    place = to_image[:, :2] @ [20.0, 15.0] + to_image[:, 2]
    cut = warp.prewarp(blob(place), to_image, (40, 30))
    assert centre_of_mass(cut) == pytest.approx([20, 15], abs=0.03)


def test_bending_points_onto_themselves_changes_nothing():
    rng = np.random.default_rng(1)
    image = rng.integers(0, 255, (50, 60, 3)).astype(np.uint8)
    points = rng.uniform(8, 42, (12, 2))
    assert np.array_equal(warp.bend(image, points, points), image)


def test_bending_carries_what_lies_at_a_point():
    source = np.array([[30.0, 30.0], [60, 20], [50, 50], [15, 45]])
    target = source.copy()
    target[0] += (4, -3)
    bent = warp.bend(blob(source[0]), source, target)
    assert centre_of_mass(bent > 0.9 * bent.max()) == pytest.approx(target[0], abs=0.5)


def test_points_that_fall_together_do_not_tear_the_picture():
    image = cv2.GaussianBlur(np.random.default_rng(2).normal(128, 60, (60, 60)), (0, 0), 3)
    source = np.array([[20.0, 30.0], [40, 30], [30, 24], [30, 36]])
    target = np.array([[20.0, 30.0], [40, 30], [30, 30], [30, 30]])
    bent = warp.bend(image.astype(np.float32), source, target)
    assert np.isfinite(bent).all()
    assert image.min() - 1 <= bent.min() <= bent.max() <= image.max() + 1


def test_a_morph_begins_and_ends_with_its_parents():
    rng = np.random.default_rng(3)
    images = rng.integers(0, 255, (2, 40, 40, 3)).astype(np.uint8)
    shapes = rng.uniform(8, 32, (2, 6, 2))
    for fraction, parent in ((0.0, 0), (1.0, 1)):
        image, shape = morph.between(tuple(images), tuple(shapes), fraction)
        assert np.array_equal(image, images[parent])
        assert shape == pytest.approx(shapes[parent])


def test_a_morph_halfway_shows_both_spots_at_one_place():
    places = np.array([[[30.0, 30], [60, 50], [20, 50]], [[36.0, 26], [60, 50], [20, 50]]])
    images = [np.repeat(blob(p[0])[..., None], 3, axis=2).astype(np.uint8) for p in places]
    image, shape = morph.between(tuple(images), tuple(places), 0.5)
    assert shape[0] == pytest.approx([33, 28])
    assert centre_of_mass(image[..., 0].astype(float)) == pytest.approx([33, 28], abs=0.3)


@pytest.mark.parametrize(("limit", "expected"), [(100, 12), (5, 5)])
def test_every_pair_is_morphed_up_to_the_limit(limit, expected):
    rng = np.random.default_rng(4)
    images = rng.integers(0, 255, (4, 24, 24, 3)).astype(np.uint8)
    shapes = rng.uniform(4, 20, (4, 5, 2))
    found = morph.enlarge(images, shapes, (0.3, 0.6), limit, np.random.default_rng(5))
    assert [len(part) for part in found] == [expected] * 3
    assert len(np.unique(found[2], axis=0)) <= 6
    for shape, (i, j) in zip(found[1], found[2], strict=True):
        mixes = [(1 - f) * shapes[i] + f * shapes[j] for f in (0.3, 0.6)]
        assert min(np.abs(shape - mix).max() for mix in mixes) < 1e-12
