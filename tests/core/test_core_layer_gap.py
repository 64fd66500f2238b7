import numpy as np
import pytest

from stages.core import layer_model, layer_published, layer_solver

LAYER = np.repeat([0, 1, 2], (5, 4, 3))
MASKS = np.eye(3)[np.repeat([0, 1, 2], 24)].T
MOUTH, SPEECH, CLOSED = 1, 1, 6
# the lips of two emotions, of the rest of speech and of one blink are closed, as those of /m/ are
GAPS = np.array([0.0, 0.0, 0.3, 0.1, 0.2, 0.0, 0.0, 0.4, 0.2, 0.0, 0.1, 0.1])


@pytest.fixture
def model():
    rng = np.random.default_rng(7)
    basis = rng.normal(size=(MASKS.shape[1], len(LAYER))) / np.sqrt(MASKS.shape[1])
    return layer_model.build(basis, LAYER, MASKS, MOUTH, SPEECH, CLOSED, GAPS)


def composed(model, weights, coefficients):
    moved = (weights[:, LAYER] * coefficients) @ model.basis.T
    return np.sum(model.masks * moved, axis=0)


def face(model, shown):
    """A face of even parts of the extremes shown, mostly of emotion."""
    coefficients = shown / np.bincount(LAYER, shown)[LAYER]
    return composed(model, np.tile([0.8, 0.2, 0.0], (3, 1)), coefficients)


def gap_of(found):
    """How far the lips are open, over the root mean square of all extremes' gaps."""
    u = found.weights[..., MOUTH, :][..., LAYER] * found.coefficients
    return u @ GAPS / np.sqrt(np.mean(GAPS**2))


def test_closed_lips_keep_an_emotion_whose_lips_are_closed(model):
    frame, kept = face(model, (GAPS == 0.0).astype(float)), {}
    for bias in layer_solver.LIP_BIASES:
        settings = layer_solver.Settings(0.0, lip_bias=bias)
        found, _ = layer_solver.solve_frame(model, settings, frame, 0.99)
        assert gap_of(found) < 0.02
        kept[bias] = found.weights[MOUTH, 0]
    assert kept["gap"] == pytest.approx(0.8, abs=1e-3)
    assert max(kept["mouth"], kept["published"]) < 0.1


def test_closed_lips_close_an_emotion_whose_lips_are_open(model):
    frame = face(model, np.ones(len(LAYER)))
    settings, gaps = layer_solver.Settings(0.0, lip_bias="gap"), []
    for closeness in (0.0, 0.5, 0.9, 1.0):
        found, _ = layer_solver.solve_frame(model, settings, frame, closeness)
        assert found.bound <= found.objective
        gaps.append(gap_of(found))
    assert np.all(np.diff(gaps) < 0.0) and gaps[0] > 0.5 and gaps[-1] < 0.05


def test_the_face_is_kept_better_than_by_a_pull_to_m(model):
    rest = face(model, (np.arange(len(LAYER)) % 2 == 0).astype(float))
    frames, errors = np.stack([rest, face(model, np.ones(len(LAYER)))]), {}
    for bias in layer_solver.LIP_BIASES:
        settings = layer_solver.Settings(0.05, lip_bias=bias)
        found = layer_solver.solve(model, settings, frames, np.array([0.0, 1.0]))
        assert gap_of(found)[1] < 0.1
        shape = composed(model, found.weights[1], found.coefficients[1])
        errors[bias] = np.linalg.norm(shape - frames[1])
    assert errors["gap"] < 0.75 * min(errors["mouth"], errors["published"])


def test_the_published_solver_closes_the_same_lips(model):
    frames = face(model, np.ones(len(LAYER)))[None]
    settings = layer_solver.Settings(0.0, lip_bias="gap")
    certified = layer_solver.solve(model, settings, frames, np.array([0.9]))
    published = layer_published.solve(model, settings, frames, np.array([0.9]))
    assert certified.objective[0] <= published.objective[0] + 1e-6
    assert gap_of(published)[0] == pytest.approx(gap_of(certified)[0], abs=0.05)


def test_the_unit_of_gaps_means_nothing(model):
    frame = face(model, np.ones(len(LAYER)))
    settings = layer_solver.Settings(0.0, lip_bias="gap")
    lips = MOUTH, SPEECH, CLOSED
    larger = layer_model.build(model.basis, LAYER, MASKS, *lips, 100 * GAPS)
    one, other = (layer_solver.solve_frame(m, settings, frame, 0.7)[0] for m in (model, larger))
    np.testing.assert_allclose(one.weights, other.weights, atol=1e-6)


def test_without_gaps_closed_lips_ask_nothing(model):
    unknown = layer_model.build(model.basis, LAYER, MASKS, MOUTH, SPEECH, CLOSED)
    frame = face(model, np.ones(len(LAYER)))
    settings = layer_solver.Settings(0.0, lip_bias="gap")
    found, free = (layer_solver.solve_frame(unknown, settings, frame, g)[0] for g in (1.0, 0.0))
    np.testing.assert_array_equal(found.weights, free.weights)


@pytest.mark.parametrize(
    ("lips", "gaps", "words"),
    [
        ((MOUTH, SPEECH, CLOSED), GAPS[1:], "gaps"),
        ((MOUTH, SPEECH, CLOSED), -GAPS, "gaps"),
        ((MOUTH, SPEECH, CLOSED), np.where(GAPS > 0, np.nan, 0.0), "gaps"),
        ((-1, -1, -1), GAPS, "lip mask"),
    ],
)
def test_refuses_gaps_that_do_not_fit(model, lips, gaps, words):
    with pytest.raises(ValueError, match=words):
        layer_model.build(model.basis, LAYER, MASKS, *lips, gaps)
