import numpy as np
import pytest

from stages.core import layer_model

BASIS = np.random.default_rng(0).normal(size=(30, 5))
LAYER = np.array([0, 0, 1, 1, 1])
MASKS = np.random.default_rng(1).dirichlet(np.ones(2), 30).T


@pytest.mark.parametrize("missing", [0, 7])
def test_data_term_is_the_squared_distance(missing):
    rng = np.random.default_rng(2)
    model = layer_model.build(BASIS, LAYER, MASKS)
    frame, u = rng.normal(size=30), rng.normal(size=(2, 5))
    frame[:missing] = np.nan
    quadratic = layer_model.project(model, frame)
    shape = np.sum(MASKS * (u @ BASIS.T), axis=0)
    far = np.nansum((frame - shape) ** 2)
    assert layer_model.data(quadratic, u.ravel()) == pytest.approx(far)
    wide = np.concatenate([BASIS * mask[:, None] for mask in MASKS], axis=1)[missing:]
    rest = np.linalg.lstsq(wide, frame[missing:])[1][0]
    assert quadratic.span == pytest.approx(rest, rel=1e-6)


def test_less_than_half_is_nothing():
    model = layer_model.build(BASIS, LAYER, MASKS)
    frame = np.zeros(30)
    frame[:15] = np.nan
    assert layer_model.project(model, frame) is not None
    frame[15] = np.nan
    assert layer_model.project(model, frame) is None


def test_only_overlapping_masks_are_pairs():
    masks = np.repeat(np.eye(3), [10, 10, 10], axis=1)
    masks[:2, 9:11] = 0.5
    model = layer_model.build(BASIS, LAYER, masks)
    assert model.pairs.tolist() == [[0, 0], [0, 1], [1, 0], [1, 1], [2, 2]]
    np.testing.assert_allclose(model.gram, model.gram.T)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"basis": BASIS[:29]}, "expected basis"),
        ({"layer": LAYER[:4]}, "expected basis"),
        ({"masks": MASKS[0]}, "expected basis"),
        ({"basis": BASIS * np.nan}, "finite"),
        ({"basis": BASIS * 0.0}, "no extreme"),
        ({"layer": np.array([0, 0, 2, 2, 2])}, "numbered"),
        ({"masks": 0.9 * MASKS}, "sum to one"),
        ({"masks": np.stack([MASKS[0] - 2, MASKS[1] + 2])}, "at least zero"),
        ({"lip_mask": 2, "speech_layer": 1, "closed": 3}, "all -1"),
        ({"lip_mask": 1, "speech_layer": 1, "closed": 0}, "all -1"),
        ({"lip_mask": 1}, "all -1"),
    ],
)
def test_refuses_what_does_not_fit(change, words):
    given = {"basis": BASIS, "layer": LAYER, "masks": MASKS} | change
    with pytest.raises(ValueError, match=words):
        layer_model.build(**given)


def test_outside_is_the_distance_from_the_simplices():
    rng = np.random.default_rng(10)
    frame = np.linalg.qr(rng.normal(size=(30, 4)))[0]
    model = layer_model.build(frame[:, :3], np.zeros(3, int), np.ones((1, 30)))
    beyond = frame @ [2.0, 0.0, 0.0, 5.0]
    nearest = np.array([1.0, 1.0, 0.0, 0.0])
    outside = layer_model.outside(model, layer_model.project(model, beyond), nearest)
    assert outside == pytest.approx(1.0, abs=1e-5)
